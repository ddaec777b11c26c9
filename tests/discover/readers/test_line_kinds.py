import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from discover.readers import line_kinds as module
from discover.readers.line_kinds import line_kinds

LINE = st.text(alphabet=' \t,;"0123456789+-.eEaZ#µ', max_size=12)


def starts_of(data):
    ends = [i + 1 for i, code in enumerate(data) if code == ord("\n")]
    if not ends or ends[-1] != len(data):
        ends.append(len(data))
    return np.array([0, *ends])


def by_definition(data, starts):
    lines = [data[a:b] for a, b in zip(starts[:-1], starts[1:], strict=True)]
    numeric = [set(x) <= set(module._NUMERIC) and bool(set(x) & set(b"0123456789")) for x in lines]
    return numeric, [set(x) <= set(module._BLANK) for x in lines]


@pytest.mark.parametrize("few", [0, 5000])
@given(lines=st.lists(LINE, min_size=1, max_size=8), ends=st.booleans())
@example(lines=["", "1"], ends=False)
@example(lines=["-", "1"], ends=True)
def test_lines_are_what_their_bytes_say(few, lines, ends):
    data = ("\n".join(lines) + ("\n" if ends else "")).encode()
    if not data:
        return
    starts = starts_of(data)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_FEW", few)
        patch.setattr(module, "_BLOCK", 7)
        numeric, blank = line_kinds(data, starts)
    assert (numeric.tolist(), blank.tolist()) == by_definition(data, starts)
