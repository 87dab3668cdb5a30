from itertools import islice

import numpy as np
import pytest

from learn.simulate import gears
from learn.simulate.gear_rows import gear_rows
from learn.simulate.gears import CLASSES, HEALTHY, TOOTH
from learn.simulate.tooth_shows import SHOWS_DB


@pytest.mark.slow
def test_rows_are_reproducible_and_a_sound_one_comes_with_a_fault_that_shows(monkeypatch):
    monkeypatch.setattr(gears, "FAST_S", 0.6)
    first, again = (list(islice(gear_rows(3, 5, 0, 1), 2)) for _ in range(2))
    assert [r.fault for r in first] == [r.fault for r in again]
    assert all(np.array_equal(a.channels, b.channels) for a, b in zip(first, again, strict=True))
    sound, faulty = first
    assert (sound.label, faulty.label) == (HEALTHY, TOOTH) == CLASSES
    assert sound.place is None
    assert faulty.place in {0, 1}
    assert faulty.clear_db >= SHOWS_DB
    assert (sound.machine, sound.rate_hz, sound.teeth) == (faulty.machine, faulty.rate_hz, faulty.teeth)
    assert all(np.all(np.isfinite(r.channels)) for r in first)
    assert not np.array_equal(sound.channels, faulty.channels)
