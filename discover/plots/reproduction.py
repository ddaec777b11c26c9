"""The paper's figures redrawn from its formulas, Table 3's spread, and orders from pipe flow."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes

from discover.plots.style import (
    ACCENT,
    INK,
    MODEL,
    MUTED,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    scaled,
)
from discover.plots.svg import to_svg
from discover.reproduction.figures import Panel, PaperFigure
from discover.reproduction.orders import OrderCurve, OrderPoint
from discover.reproduction.tables import ComparisonRow

_CURVES: dict[str, dict[str, Any]] = {
    "IOIM": {"color": INK, "linewidth": 1.7},
    "FOIM (M1)": {"color": "#009e73", "dashes": (2, 1.5)},
    "FOIM (M2)": {"color": MODEL, "dashes": (5, 2)},
    "FOIM (M3)": {"color": ACCENT, "dashes": (5, 2)},
}
_NUMBERS: dict[str, dict[str, Any]] = {
    "[12], 5 mm": {"color": MODEL},
    "[12], 10 mm": {"color": MODEL, "dashes": (4, 2)},
    "[10], 5 mm": {"color": ACCENT},
    "[10], 10 mm": {"color": ACCENT, "dashes": (4, 2)},
}
_CRITERIA = {"Re amplitude": 2000.0, "De amplitude": 100.0}


def paper_figure(figure: PaperFigure) -> str:
    """Draw one of the paper's figures as an ``<svg>`` element."""
    with house_style():
        columns = len(figure.panels)
        width = {1: 620, 2: 860}.get(columns, 1120)
        drawing = new_figure(width, 310)
        axes = drawing.subplots(1, columns, squeeze=False)[0]
        for one, panel in zip(axes, figure.panels, strict=True):
            if figure.kind == "numbers":
                _draw_numbers(one, panel)
            else:
                _draw_force(one, panel)
        handles = {
            label: handle
            for one in axes
            for handle, label in zip(*one.get_legend_handles_labels(), strict=True)
        }
        legend_above(drawing, list(handles.values()), list(handles), ncols=6)
        title = f"Figure {figure.number} of the paper, redrawn"
        return to_svg(drawing, name=f"paper-figure-{figure.number}", title=title)


def _draw_force(axes: Axes, panel: Panel) -> None:
    peak = max(float(abs(curve.y).max()) for curve in panel.curves)
    scale, unit = scaled(peak, "N")
    for curve in panel.curves:
        axes.plot(curve.x, scale * curve.y, label=curve.label, **_CURVES[curve.label])
    axes.set(xlabel="Time (s)", ylabel=f"Force ({unit})")
    axes.set_title(f"{panel.title}\n{panel.note}", fontsize=9.0, fontweight="normal")
    axes.locator_params(nbins=5)


def _draw_numbers(axes: Axes, panel: Panel) -> None:
    for curve in panel.curves:
        axes.loglog(curve.x, curve.y, label=curve.label, **_NUMBERS[curve.label])
    criterion = _CRITERIA[panel.title]
    axes.axhline(criterion, color=MUTED, linewidth=1.0)
    axes.annotate(
        f"{criterion:g}", (0.01, criterion), xytext=(2, 3), textcoords="offset points",
        color=MUTED, fontsize=8.5,
    )
    axes.set(xlabel="Frequency (Hz)", ylabel=panel.title, xlim=(0.01, 5.0))
    for which in ("x", "y"):
        plain_log_axis(axes, which=which)


def table_3_figure(rows: tuple[ComparisonRow, ...]) -> str:
    """Draw Table 3: printed value, recomputed value, and the spread of the printed rounding."""
    with house_style():
        drawing = new_figure(760, 300)
        axes = drawing.subplots()
        places = range(len(rows))
        for place, row in zip(places, rows, strict=True):
            axes.plot(
                [row.lowest, row.highest], [place, place], color=ACCENT, linewidth=7,
                solid_capstyle="butt", alpha=0.35,
                label="within the rounding of b0 and order" if place == 0 else None,
            )
        axes.plot(
            [row.computed for row in rows], places, "o", color=ACCENT, markersize=6,
            label="recomputed at the printed parameters",
        )
        axes.plot(
            [row.printed.error_percent for row in rows], places, "D", color=MODEL, markersize=6,
            label="printed",
        )
        axes.set_xscale("log")
        axes.set_xlim(0.15, 30.0)
        axes.set_yticks(list(places), [row.printed.condition.label for row in rows])
        axes.invert_yaxis()
        axes.set_xlabel("e_d, fractional against integer-order model (% of the peak)")
        plain_log_axis(axes, which="x")
        axes.grid(visible=False, axis="y")
        legend_above(drawing, ncols=3)
        title = "Table 3: printed and recomputed errors with the spread of the printed rounding"
        return to_svg(drawing, name="table-3", title=title)


def order_figure(curve: OrderCurve, points: tuple[OrderPoint, ...]) -> str:
    """Draw the order of laminar pipe flow over the Womersley number, beside identified ones."""
    with house_style():
        drawing = new_figure(760, 340)
        axes = drawing.subplots()
        axes.semilogx(curve.womersley, curve.by_phase, color=INK, label="laminar flow, by phase")
        axes.semilogx(
            curve.womersley, curve.by_amplitude, color=INK, dashes=(4, 2),
            label="laminar flow, by amplitude",
        )
        womersley = [point.womersley for point in points]
        axes.plot(
            womersley, [point.integer_model for point in points], "s", color=ACCENT, markersize=6,
            label="integer-order model, by phase",
        )
        axes.plot(
            womersley, [point.identified.order for point in points], "D", color=MODEL,
            markersize=7, label="identified in the paper",
        )
        for point in points:
            axes.annotate(
                point.identified.name, (point.womersley, point.identified.order),
                xytext=(0, -15), textcoords="offset points", ha="center", color=MODEL, fontsize=9,
            )
        for order, text in ((1.0, "damper"), (1.5, "Stokes layer"), (2.0, "inerter")):
            axes.axhline(order, color=MUTED, linewidth=0.8)
            axes.annotate(
                text, (290.0, order), xytext=(0, -10), textcoords="offset points", ha="right",
                color=MUTED, fontsize=8.5,
            )
        axes.set(xlabel="Womersley number", ylabel="Order", xlim=(0.1, 300.0), ylim=(0.3, 2.1))
        plain_log_axis(axes, which="x")
        legend_above(drawing, ncols=2)
        title = "Order of laminar pipe flow over the Womersley number, and the identified orders"
        return to_svg(drawing, name="orders", title=title)
