"""``inerter synth``: a campaign from the virtual test rig, or exact records of a model."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import hold_folder, working
from discover.report.folder import check_replaceable, write_folder
from discover.words import counted
from models.checks import InputError

if TYPE_CHECKING:
    from models.rig import Limits

_AMPLITUDES = "5,10,20"
_LARGEST = 100.0  # of noise or a hidden effect over the force


def synth(
    context: typer.Context,
    folder: Annotated[
        Path, typer.Argument(metavar="CAMPAIGN-OUT", help="New or empty folder of the campaign.")
    ],
    device: Annotated[
        str,
        typer.Option(
            "--device", metavar="DEVICE", help="device-12, device-10, or a campaign that has one."
        ),
    ],
    model: Annotated[
        str | None,
        typer.Option(
            "--model",
            metavar="M",
            help="Exact records of this model instead of the rig: ioim-laminar, ioim-turbulent,"
            " foim, sfoim, or a model.json.",
        ),
    ] = None,
    hide: Annotated[
        list[str] | None,
        typer.Option(
            "--hide",
            metavar="EFFECT=SIZE",
            help="Hide an effect; its size is rms change in force over rms force, as 3% or 0.03."
            " May be given several times; EFFECT:FORM=SIZE chooses its physical form.",
        ),
    ] = None,
    noise: Annotated[
        str,
        typer.Option(
            "--noise", metavar="SHARE", help="Force noise, rms over rms force, as 1% or 0.01."
        ),
    ] = "1%",
    frequencies: Annotated[
        str | None,
        typer.Option(
            "--frequencies",
            metavar="GRID",
            help="Hz, as 0.5,1,2 or 1:10:1 [default: twelve from 0.1 to 15].",
        ),
    ] = None,
    amplitudes: Annotated[
        str, typer.Option("--amplitudes", metavar="GRID", help="mm, likewise.")
    ] = _AMPLITUDES,
    held_out: Annotated[
        int,
        typer.Option(
            "--held-out", metavar="N", min=0, help="How many records are marked as held out."
        ),
    ] = 0,
    effect_files: Annotated[
        list[Path] | None,
        typer.Option(
            "--effect-file",
            metavar="FILE.py",
            help="An effect of your own that the model.json of --model names; --hide knows only"
            " the rig's effects. May be given again.",
        ),
    ] = None,
    title: Annotated[
        str | None, typer.Option("--title", metavar="TEXT", help="Of the campaign.")
    ] = None,
    seed: options.Seed = options.DEFAULT_SEED,
) -> int:
    """Write a campaign from the virtual test rig.

    Sine tests of a device, with effects hidden in it by --hide; with --model exact records of a
    model, and noise.
    """
    _check_together(model, hide, effect_files)
    share = fraction(noise, where="--noise")
    sizes = dict(_hidden(item) for item in hide or ())
    grid_hz = options.grid(frequencies, where="--frequencies", at_least=1e-3, at_most=1e3)
    grid_mm = options.grid(amplitudes, where="--amplitudes", at_least=1e-3, at_most=1e4) or ()
    hold_folder(folder)
    check_replaceable(folder, fresh=True)

    from discover.cli.known_device import known_device
    from discover.cli.own_effects import own_effects
    from discover.cli.synthesis import campaign_files, model_records, rig_records
    from models.rig import Limits, sine_plan
    from models.terms import own_terms

    with working("Reading effects"):
        own = own_effects(effect_files)
    context.with_resource(own_terms(*own))
    tested = known_device(device)
    limits = Limits()
    plan = sine_plan(
        tested,
        frequencies=grid_hz,
        amplitudes=[1e-3 * a for a in grid_mm],
        limits=limits,
        held_out=held_out,
    )
    with working(f"Testing {len(plan)} points"):
        if model is None:
            records, hidden = rig_records(tested, plan, noise=share, hidden=sizes, seed=seed)
        else:
            hidden = ()
            records = model_records(model, tested, plan, noise=share, seed=seed)
        invocation: Invocation = context.obj
        files = campaign_files(
            records,
            tested,
            limits,
            title=title or _title(device, model),
            command=invocation.repeat(seed=seed),
            hidden=hidden,
        )
    written = write_folder(folder, files, fresh=True)
    asked = len(plan) if grid_hz is None else len(grid_hz) * len(grid_mm)
    if len(plan) < asked:
        typer.echo(_left_out(asked - len(plan), limits))
    for what in hidden:
        typer.echo(f"Hidden: {what}")
    then = f"inerter check {shlex.quote(str(written))}"
    typer.echo(f"{counted(len(records), 'record')} in {written}; next: {then}")
    return 0


def _check_together(
    model: str | None, hide: Sequence[str] | None, effect_files: Sequence[Path] | None
) -> None:
    """Refuse options that do not go together: the rig has effects, a model has its own terms."""
    if model is not None and hide:
        raise InputError("--hide", expected="used with the rig", found="--model", where="synth")
    if model is None and effect_files:
        raise InputError(
            "--effect-file",
            expected="used with --model (--hide knows only the rig's effects)",
            found="no --model",
            where="synth",
        )


def _left_out(count: int, limits: Limits) -> str:
    """Return the line on tests of the grids that the rig can't do."""
    return (
        f"{counted(count, 'test')} left out: beyond the rig's {1e3 * limits.stroke:g} mm,"
        f" {limits.speed:g} m/s, {limits.acceleration:.0f} m/s^2 or {1e-3 * limits.force:g} kN."
    )


def fraction(text: str, *, where: str) -> float:
    """Return ``3%`` or ``0.03`` as a fraction.

    Raises
    ------
    InputError
        For text that is no number, or a negative one.

    Examples
    --------
    >>> fraction("3%", where="--noise"), fraction("0.03", where="--noise")
    (0.03, 0.03)
    """
    plain = text.strip()
    percent = plain.endswith("%")
    try:
        size = float(plain.removesuffix("%")) / (100.0 if percent else 1.0)
    except ValueError:
        size = -1.0
    if not 0.0 <= size <= (_LARGEST if percent else 1.0):
        raise InputError("size", expected="a share as 3% or 0.03", found=repr(plain), where=where)
    return size


def _hidden(text: str) -> tuple[str, float]:
    match = re.fullmatch(r"\s*([^=]+?)\s*=\s*(\S+)\s*", text)
    if match is None:
        raise InputError("effect", expected="EFFECT=SIZE", found=repr(text), where="--hide")
    return match[1], fraction(match[2], where=f"--hide {match[1]}")


def _title(device: str, model: str | None) -> str:
    made = "virtual test rig" if model is None else f"exact records of {Path(model).stem}"
    return f"{device}, sine tests, {made} (simulated)"
