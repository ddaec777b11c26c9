import pytest
from hypothesis import given
from hypothesis import strategies as st

from discover.cli.invocation import Invocation
from discover.cli.options import grid, identifiers
from discover.cli.synth import fraction
from models.checks import InputError


@given(
    start=st.integers(0, 20), count=st.integers(0, 60), step=st.sampled_from(["0.1", "0.05", "1"])
)
def test_grid_holds_both_ends_and_even_steps(start, count, step):
    width = float(step)
    stop = start + count * width
    values = grid(f"{start}:{stop:.10g}:{step}", where="--orders")
    assert values[0] == start
    assert values[-1] == pytest.approx(stop, abs=1e-9)
    assert len(values) == count + 1


def test_grid_stops_short_of_an_end_that_no_step_meets():
    assert grid("0:1:0.4", where="--orders") == (0.0, 0.4, 0.8)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0:2", "--orders: grid must be start:stop:step or a,b,c, got 0:2"),
        ("0:2:0", "rising, with a step above 0"),
        ("2:0:0.1", "rising"),
        ("0:2:1e-9", "at most 1000 values"),
        ("a,b", "value must be a finite number, got 'a'"),
        ("0.5,,1", "value must be a finite number, got ''"),
        ("nan", "finite number"),
    ],
)
def test_grid_says_what_is_wrong(text, message):
    with pytest.raises(InputError, match=message):
        grid(text, where="--orders")


def test_identifiers_refuse_gaps_and_repeats():
    with pytest.raises(InputError, match="single commas"):
        identifiers("inertia,,stiffness", where="--terms")
    with pytest.raises(InputError, match="inertia twice"):
        identifiers("inertia,inertia", where="--terms")
    assert identifiers(None, where="--terms") is None


@pytest.mark.parametrize("text", ["-1%", "5", "5N", "nan", "inf%", ""])
def test_fraction_reads_percent_and_refuses_what_is_no_share(text):
    """A forgotten % would hide a five-hundred-fold effect."""
    assert fraction(" 2.5 % ", where="--noise") == 0.025
    assert fraction("120%", where="--noise") == 1.2
    with pytest.raises(InputError, match=r"--noise: size must be a share as 3% or 0.03, got"):
        fraction(text, where="--noise")


def test_the_repeating_command_keeps_a_given_seed():
    assert Invocation(("discover", "--seed=7")).repeat(seed=7) == "inerter discover --seed=7"
    assert Invocation(("discover",)).repeat(seed=0) == "inerter discover --seed 0"
