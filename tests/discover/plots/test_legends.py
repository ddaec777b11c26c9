"""Legends are as wide as their picture at most, and numbers on a map stand free."""

import pytest

from discover.figure_data import PlanFigureData, PlannedTest
from discover.plots.plan_map import plan_map
from discover.plots.style import house_style, legend_above, new_figure


@pytest.mark.parametrize(("length", "columns"), [(4, 4), (30, 2), (200, 1)])
def test_a_legend_has_as_many_columns_as_its_picture_has_room_for(length, columns):
    with house_style():
        figure = new_figure(620, 300)
        axes = figure.add_subplot()
        lines = [axes.plot([0, 1], [0, i])[0] for i in range(4)]
        legend_above(figure, lines, [str(i) * length for i in range(4)], ncols=4)
        figure.draw_without_rendering()
    (legend,) = figure.legends
    places = {round(text.get_window_extent().x0) for text in legend.get_texts()}
    assert len(places) == columns
    if columns > 1:
        assert legend.get_window_extent().x1 <= 620


def test_a_legend_that_would_fit_but_for_its_margin_has_a_column_less():
    names = [*(f"random-{mm}mm-{i}.csv" for mm, i in ((2, 1), (4, 2), (4, 4), (8, 3))), "model"]
    with house_style():
        figure = new_figure(620, 300)
        axes = figure.add_subplot()
        lines = [axes.plot([0, 1], [0, i])[0] for i in range(5)]
        legend_above(figure, lines, names, ncols=4, columnspacing=1.2, handletextpad=0.5)
        figure.draw_without_rendering()
    assert figure.legends[0].get_window_extent().x1 <= 620


def planned(frequency, amplitude):
    return PlannedTest(
        file=f"{frequency}.csv", kind="sine", held_out=False, frequency=frequency,
        amplitude=amplitude, noise_percent=0.95, level="",
    )  # fmt: skip


def test_numbers_of_tests_side_by_side_do_not_touch():
    tests = tuple(planned(1.0 * 1.13**i, 0.01) for i in range(24))
    texts = [
        t for axes in plan_map(PlanFigureData(tests)).figure.axes for t in axes.texts
        if t.get_text() == "0.95 %"
    ]  # fmt: skip
    assert 5 < len(texts) < len(tests)
    boxes = sorted((t.get_window_extent() for t in texts), key=lambda b: b.x0)
    assert all(a.x1 < b.x0 for a, b in zip(boxes, boxes[1:], strict=False))
