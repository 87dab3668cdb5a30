"""The band-limited step: a jump that keeps what lies below the filter's edge and nothing of what would fold."""

from __future__ import annotations

import numpy as np
import pytest

from sim.parts.band_limit import CELLS, POINTS, REACH, step_response, step_share
from sim.solve.plain import interpreted, view


def spectrum(frequency):
    """Response of the filter whose step response is tabled, at a frequency over the sampling rate."""
    after = step_response()
    both = np.concatenate([1.0 - after[:0:-1], after])
    shape = np.diff(both)
    at = (np.arange(shape.size) - 0.5 * (shape.size - 1)) / CELLS
    return abs(np.sum(shape * np.exp(-2j * np.pi * frequency * at)))


@pytest.mark.parametrize("frequency", [0.0, 0.05, 0.1, 0.2])
def test_what_the_decimation_passes_is_kept(frequency):
    assert spectrum(frequency) == pytest.approx(1.0, abs=5e-4)


@pytest.mark.parametrize("frequency", [0.8, 0.95, 1.0, 1.2, 2.0])
def test_what_would_fold_there_is_gone(frequency):
    assert 20.0 * np.log10(spectrum(frequency)) < -65.0


def test_the_share_is_the_table_and_its_mirror_image():
    table, share = view(np.array([7.0, *step_response()])), interpreted(step_share)
    assert len(table) == POINTS + 1
    assert [share(table, 1.0, x) for x in (-REACH, -9.0, 0.0, REACH, 9.0)] == pytest.approx([0, 0, 0.5, 1, 1])
    for x in np.linspace(0.01, 4.99, 23):
        assert share(table, 1.0, x) + share(table, 1.0, -x) == pytest.approx(1.0, abs=1e-14)
        exact = np.interp(x * CELLS, np.arange(POINTS), step_response())
        assert share(table, 1.0, x) == pytest.approx(exact, abs=1e-14)
