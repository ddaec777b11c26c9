"""What a plan of tests can tell apart: expected nats of every two structures, conditioning."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from discover.data_check import TELLING
from discover.plots.style import INK, MUTED, STRUCTURE_COLOURS, house_style, new_figure
from discover.plots.svg import to_svg

_OPEN = ("#f3b34c", INK, f"below {TELLING:.0f} nats: can't be told apart")
_TOLD = (
    (10.0, "#dbe9f5", INK, f"{TELLING:.0f} to 10 nats"),
    (100.0, "#9cc6e4", INK, "10 to 100 nats"),
    (math.inf, "#2476ad", "white", "above 100 nats: told apart"),
)
_NESTED = ("#eef1f5", MUTED, "nested: the fitted one holds the true one")
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def separation_matrix(document: Mapping[str, Any]) -> str | None:
    """Draw the matrix of pairwise expected nats, or return None where nothing may be fitted.

    A row is the structure that is true, a column the one that is fitted to its force. Beside each
    row stands how well its parameters are conditioned.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.

    Returns
    -------
    str or None
        One ``<svg>`` element.
    """
    structures = document["structures"]
    if not structures:
        return None
    names = [str(s["name"]) for s in structures]
    gaps = {(g["truth"], g["model"]): g for pair in document["pairs"] for g in pair["expected"]}
    with house_style():
        figure = new_figure(660, 450)
        matrix, bars = figure.subplots(1, 2, width_ratios=(4.0, 1.3), sharey=True)
        _cells(matrix, names, gaps)
        _conditions(bars, structures)
        figure.legend(
            handles=_legend(gaps.values()),
            loc="outside lower left",
            ncols=2,
            handlelength=1.1,
            columnspacing=1.4,
        )
        title = "Expected log-likelihood gap between structures, and their conditioning"
        return to_svg(figure, name="separation", title=title)


def _look(gap: Mapping[str, Any]) -> tuple[str, str, str]:
    """Return a cell's colour, the colour of its text, and what the legend says of it."""
    if gap["word"] == "nested":
        return _NESTED
    nats = float(gap["gap_nats"])
    if nats < TELLING:
        return _OPEN
    return next((fill, ink, name) for limit, fill, ink, name in _TOLD if nats < limit)


def _legend(gaps: Any) -> list[Patch]:
    """Return a patch for each class that some cell is in, the least telling first."""
    used = {_look(g) for g in gaps}
    order = (_OPEN, *((fill, ink, name) for _, fill, ink, name in _TOLD), _NESTED)
    return [Patch(facecolor=c[0], edgecolor="#aab4c0", label=c[2]) for c in order if c in used]


def _cells(
    axes: Axes, names: Sequence[str], gaps: Mapping[tuple[str, str], Mapping[str, Any]]
) -> None:
    count = len(names)
    for row, truth in enumerate(names):
        for column, model in enumerate(names):
            gap = gaps.get((truth, model))
            if gap is None:
                axes.text(column, row, "–", ha="center", va="center", color=MUTED)
                continue
            fill, ink, _ = _look(gap)
            cell = Rectangle((column - 0.5, row - 0.5), 1.0, 1.0, facecolor=fill, edgecolor="white")
            cell.set_linewidth(2.0)
            axes.add_patch(cell)
            nested = gap["word"] == "nested"
            axes.text(
                column,
                row,
                "nested" if nested else nats_text(float(gap["gap_nats"])),
                ha="center",
                va="center",
                color=ink,
                fontsize=9.5,
                fontweight="normal" if nested else "bold",
            )
    axes.set_xlim(-0.5, count - 0.5)
    axes.set_ylim(count - 0.5, -0.5)
    axes.set_xticks(range(count), [n.replace("IOIM-", "IOIM-\n") for n in names])
    axes.set_yticks(range(count), names)
    for label in (*axes.get_xticklabels(), *axes.get_yticklabels()):
        label.set_color(INK)
    axes.tick_params(length=0)
    axes.grid(visible=False)
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.set_xlabel("Fitted structure")
    axes.set_ylabel("True structure")
    axes.set_title("Expected gap (nats)")


def _conditions(axes: Axes, structures: Sequence[Mapping[str, Any]]) -> None:
    """Draw the condition number of each structure as a bar, with its rank in words."""
    known = [float(s["condition"]) for s in structures if s["condition"] is not None]
    right = 10.0 * max([10.0, *known])
    for row, structure in enumerate(structures):
        condition = structure["condition"]
        text = "no unique solution" if condition is None else f"{float(condition):.3g}"
        full = structure["rank"] == structure["columns"]
        axes.barh(
            row,
            right if condition is None else float(condition),
            height=0.3,
            color=STRUCTURE_COLOURS.get(str(structure["name"]), STRUCTURE_COLOURS["other"]),
        )
        axes.text(
            1.0,
            row - 0.22,
            f"{text} · rank {structure['rank']} of {structure['columns']}",
            ha="left",
            va="bottom",
            fontsize=10,
            color=INK if full else "#a83a00",
            fontweight="normal" if full else "bold",
        )
    axes.set_xscale("log")
    axes.set_xlim(1.0, right)
    decades = [10.0**d for d in range(math.ceil(math.log10(right)) + 1) if 10.0**d <= right]
    axes.set_xticks(decades, [f"{d:g}" for d in decades])
    axes.minorticks_off()
    axes.tick_params(axis="y", length=0, labelleft=False)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("Condition number", fontsize=10, loc="left")
    axes.set_title("Conditioning")


def nats_text(nats: float) -> str:
    """Return nats to two digits, as a power of ten where they are many.

    Examples
    --------
    >>> [nats_text(n) for n in (1e-11, 0.24, 345.0, 5.81e6)]
    ['0', '0.24', '345', '5.8×10⁶']
    """
    if nats < 0.005:
        return "0"
    if nats < 10.0:
        return f"{nats:.2g}"
    if nats < 9999.5:
        return f"{nats:.0f}"
    mantissa, power = f"{nats:.1e}".split("e")
    return f"{mantissa}×10{str(int(power)).translate(_SUPERSCRIPTS)}"
