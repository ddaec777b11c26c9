"""``inerter design``: the geometry with the lowest critical frequency under bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from discover._version import __version__
from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import deliver, result_folder, working
from models.checks import one_of

if TYPE_CHECKING:
    from models.device import Device, Fluid

FAILED = 1


def design(
    context: typer.Context,
    device: Annotated[
        str,
        typer.Option(
            "--device",
            metavar="DEVICE",
            help="To improve on: device-12, device-10, or a campaign with one.",
        ),
    ] = "device-12",
    amplitude: Annotated[
        str,
        typer.Option(
            "--amplitude",
            metavar="QUANTITY",
            help="Displacement amplitude that f_low is judged at.",
        ),
    ] = "5 mm",
    frequency: Annotated[
        str,
        typer.Option(
            "--frequency",
            metavar="QUANTITY",
            help="Highest working frequency: damping is judged there.",
        ),
    ] = "10 Hz",
    inertance: Annotated[
        str | None,
        typer.Option(
            "--inertance", metavar="QUANTITY", help="Wanted, as '300 kg' [default: the device's]."
        ),
    ] = None,
    at_least: Annotated[
        bool, typer.Option("--at-least", help="More inertance than wanted is welcome.")
    ] = False,
    damping_ratio: Annotated[
        float,
        typer.Option(
            "--damping-ratio",
            metavar="NUMBER",
            min=0.0,
            help="Largest damping over the device's own.",
        ),
    ] = 2.0,
    package_radius: Annotated[
        str | None,
        typer.Option(
            "--package-radius", metavar="QUANTITY", help="Outer radius [default: the device's]."
        ),
    ] = None,
    package_length: Annotated[
        str | None,
        typer.Option("--package-length", metavar="QUANTITY", help="Height of the helix, likewise."),
    ] = None,
    pressure: Annotated[
        str | None,
        typer.Option(
            "--pressure",
            metavar="QUANTITY",
            help="Largest pressure difference over the piston, as '5 MPa'.",
        ),
    ] = None,
    fluids: Annotated[
        str | None,
        typer.Option(
            "--fluids",
            metavar="NAME,NAME,…",
            help="What may be filled in: own, water, oil-vg-2 to oil-vg-46 [default: own].",
        ),
    ] = None,
    verify: Annotated[
        bool,
        typer.Option(
            "--verify/--no-verify",
            help="Test the design on the virtual rig and discover from its records whether one"
            " FOIM serves.",
        ),
    ] = True,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
) -> int:
    """Find the design with the lowest critical frequency.

    Geometry and fluid, within bounds.

    Exits 1 where nothing fits; the result then says which bounds keep every design out.
    """
    from discover.cli.design_loop import close_loop
    from discover.cli.known_device import known_device
    from discover.readers.units import quantity
    from discover.report.design import design_figures, design_lines, design_report
    from discover.report.files import page_files
    from models.design import DesignBounds, Duty, minimise_critical_frequency

    baseline = known_device(device)
    offered = _chosen_fluids(fluids, baseline)
    duty = Duty(
        amplitude=quantity(amplitude, "length", name="amplitude", where="--amplitude"),
        frequency=quantity(frequency, "frequency", name="frequency", where="--frequency"),
    )
    bounds = DesignBounds.around(
        baseline,
        duty=duty,
        damping_ratio=damping_ratio,
        inertance_rule="at-least" if at_least else "equal",
    )
    stated = {
        "inertance": (inertance, "mass"),
        "package_radius": (package_radius, "length"),
        "package_length": (package_length, "length"),
        "pressure": (pressure, "pressure"),
    }
    bounds = replace(bounds, **_quantities(stated))
    folder = result_folder("design", device, out)
    with working("Designing"):
        result = minimise_critical_frequency(
            baseline, duty=duty, bounds=bounds, fluids=offered, seed=seed
        )
    with working("Testing the design on the virtual rig"):
        loop = close_loop(result, seed=seed, jobs=jobs) if verify else None
    with working("Drawing"):
        document = {
            "schema": "inerter.design/1",
            "version": __version__,
            "seed": seed,
            "campaign": {"title": f"Rough design from {Path(device).name}", "hash": ""},
            **result.to_dict(),
            "loop": loop,
        }
        figures = design_figures(document)
        invocation: Invocation = context.obj
        page = design_report(document, figures, command=invocation.repeat(seed=seed))
    deliver(
        document,
        name="design.json",
        folder=folder,
        files=page_files(page, figures),
        summary=design_lines(document),
        as_json=as_json,
    )
    return 0 if result.feasible else FAILED


def _chosen_fluids(names: str | None, baseline: Device) -> dict[str, Fluid]:
    """Return the fluids that may be filled in, by name; the device's own where none is named."""
    from models.design import FLUIDS

    offered = {"own": baseline.fluid, **FLUIDS}
    chosen = options.identifiers(names, where="--fluids") or ("own",)
    for name in chosen:
        one_of("fluid", name, offered, where="--fluids")
    return {name: offered[name] for name in chosen}


def _quantities(stated: Mapping[str, tuple[str | None, str]]) -> dict[str, Any]:
    """Return the quantities that were typed, in SI: text and kind of each by its option's name."""
    from discover.readers.units import quantity

    return {
        name: quantity(text, kind, name=name, where="--" + name.replace("_", "-"))
        for name, (text, kind) in stated.items()
        if text is not None
    }
