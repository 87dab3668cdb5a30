from itertools import islice

import numpy as np
import pytest

from learn.simulate.gear_rows import gear_rows
from learn.simulate.gears import CLASSES


@pytest.mark.slow
def test_rows_are_reproducible_and_labelled():
    first, again = (list(islice(gear_rows(6, 2, 0, 12), 3)) for _ in range(2))
    assert [r.fault for r in first] == [r.fault for r in again]
    assert all(np.array_equal(a.channels, b.channels) for a, b in zip(first, again, strict=True))
    assert {r.label for r in first} <= set(CLASSES)
    assert all((r.place is None) == (r.label == "healthy") for r in first)
    assert all(np.all(np.isfinite(r.channels)) for r in first)
