import numpy as np
import pytest

from models.checks import InputError
from models.rig.reversal import Reversal, tabulate


def flat(u):
    return np.zeros_like(u)


def test_table_is_read_only_and_ends_at_the_limit():
    table = tabulate(Reversal("line", lambda u: np.minimum(u, 1.0), flat))
    assert table[0] == 0.0
    assert table[-1] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        table[0] = 1.0


@pytest.mark.parametrize(
    ("rise", "found"),
    [
        (lambda u: np.minimum(u, 0.4), "0 to 0.4"),
        (lambda u: 0.1 + np.minimum(u, 0.9), "0.1 to 1"),
        (lambda u: u * np.nan, "nan to nan"),
    ],
)
def test_a_curve_that_is_no_share_of_a_limit_is_refused(rise, found):
    with pytest.raises(InputError, match=f"reversal bad: rise must be from 0 .* got {found}"):
        Reversal("bad", rise, flat)
