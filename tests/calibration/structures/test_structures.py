"""A small part of the study, held to its bars less the error of a count.

Of the 954 campaigns of the kept table as many as 27, by fixed steps through the sets of one seed:
8 of "structures", 7 of "two-boundaries", 5 of "one-extra", 3 of "outside" and 4 of "thin".
"""

import pytest

from models.terms import TERMS
from tests.calibration.counting import holds
from tests.calibration.structures.run import outcomes
from tests.calibration.structures.sets import cases
from tests.calibration.structures.table import BARS, SURE

pytestmark = pytest.mark.sweep
SEED = 700  # apart from those of the kept table


def answered(name, every, kept=lambda case: True):
    """Return the outcomes of a part of a set."""
    return list(outcomes([c for c in cases(name, [SEED]) if kept(c)][::every]))


def sure_are_right(found):
    """Tell whether the answers stated above 0.9 are right as often as they have to be.

    Of two such answers or more; fewer have not been surer than right.
    """
    sure = [o.core_right for o in found if o.stated is not None and o.stated > SURE]
    return len(sure) < 2 or holds(sure, 1.0 - BARS["structures"]["sure"])


def test_cores_and_boundaries_are_found():
    bars, found = BARS["structures"], answered("structures", 7)
    whole = [o for o in found if o.kind != "SFOIM"]
    parted = [o for o in found if o.kind == "SFOIM"]
    assert holds([o.core_right for o in found], bars["first"])
    assert holds([o.core_listed for o in found], bars["listed"])
    assert holds([o.bands == 1 for o in whole], bars["none"])
    assert holds([all(o.brackets) for o in parted], bars["bracket"])
    told = [o.coordinate_right for o in parted if o.coordinate_right is not None]
    assert holds(told, bars["coordinate"])
    assert sure_are_right(found)


def test_two_boundaries_are_found():
    bars = BARS["two-boundaries"]
    three = answered("two-boundaries", 1, lambda case: case.place < 4)
    assert holds([o.bands_right for o in three], bars["number"])
    assert holds([all(o.brackets) for o in three], bars["brackets"])


def test_gradual_boundaries_are_found_as_such():
    gradual = answered("two-boundaries", 1, lambda case: case.kind == "gradual")
    assert holds([o.bands_right for o in gradual], BARS["two-boundaries"]["number"])


def test_extras_are_named_beside_their_cores():
    """Each added force and a delay, in another kind of device each."""
    named = {i for i, t in TERMS.items() if t.acts == "force"} | {"time-delay"}
    bars, found = BARS["one-extra"], answered("one-extra", 6, lambda case: case.effect in named)
    assert holds([o.core_right for o in found], bars["first"])
    assert holds([o.bands == 1 for o in found if o.kind != "SFOIM"], bars["none"])
    assert holds([o.extra_right for o in found], bars["extra"])
    assert sure_are_right(found)


# Devices with play or compliance take minutes each: only the whole study runs them.


def test_what_is_outside_is_a_remainder_of_its_size():
    bars, found = BARS["outside"], answered("outside", 16)
    assert holds([o.core_right for o in found], bars["first"])
    assert holds([o.bands == 1 for o in found if o.kind != "SFOIM"], bars["none"])
    assert holds([o.remainder_right for o in found], bars["remainder"])
    assert sure_are_right(found)


def test_thin_data_are_not_surer_than_right():
    """One campaign of each kind of device, in another law of friction each."""
    assert sure_are_right(answered("thin", 11))
