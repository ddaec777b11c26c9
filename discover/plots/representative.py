"""Which records a page shows at length."""

from __future__ import annotations

from collections.abc import Sequence

from discover.figure_data import ShownRecord
from discover.plots.loops import top_speed


def representative(records: Sequence[ShownRecord], *, most: int = 4) -> list[ShownRecord]:
    """Return a few records that show the most: the ends of each band, and a held-out one.

    Within a band the slowest and the fastest test are taken (by speed amplitude); where there is
    room, the record that the model misses most and a held-out one come in.
    """
    with_force = [r for r in records if r.force.size and r.predictions]
    chosen: list[ShownRecord] = []

    def take(record: ShownRecord | None) -> None:
        if record is not None and not any(record is c for c in chosen) and len(chosen) < most:
            chosen.append(record)

    place = {id(r): getattr(r, "band", 0) for r in with_force}
    bands = sorted({b for b in place.values() if b is not None})
    for band in bands:
        inside = sorted((r for r in with_force if place[id(r)] == band), key=top_speed)
        if len(bands) > 1:
            take(inside[len(inside) // 2])
        else:
            take(inside[0])
            take(inside[-1])
    take(max((r for r in with_force if r.held_out), key=top_speed, default=None))
    with_error = (r for r in with_force if _relative_error(r) is not None)
    take(max(with_error, key=_error_over_noise, default=None))
    for record in sorted(with_force, key=top_speed, reverse=True):
        take(record)
    position = {id(r): i for i, r in enumerate(records)}
    return sorted(chosen, key=lambda r: (top_speed(r), position[id(r)]))


def _relative_error(record: ShownRecord) -> float | None:
    return record.errors_percent[0] if record.errors_percent else None


def _error_over_noise(record: ShownRecord) -> float:
    return (_relative_error(record) or 0.0) - (record.noise_percent or 0.0)
