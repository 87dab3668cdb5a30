"""The same samples sent twice are refused, wherever they stand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.entry import reconcile_recordings
from reconcile.repeated import check_repeated
from sim.core.errors import SpecError
from tests.reconcile.test_entry import MACHINE, recording


def test_a_recording_against_itself_is_refused() -> None:
    one = recording(seconds=0.1)
    with pytest.raises(SpecError, match=r"baseline\[0\].samples.*same samples as recording\[0\].*against itself"):
        check_repeated([one], [replace(one, samples=one.samples.copy())])
    with pytest.raises(SpecError, match="every recording once"):
        reconcile_recordings(MACHINE, [one], [one])


def test_a_test_given_twice_is_refused_and_like_ones_are_not() -> None:
    one = recording(seconds=0.1)
    with pytest.raises(SpecError, match=r"recording\[1\].samples"):
        check_repeated([one, one], [])
    shorter = replace(one, samples=one.samples[:, :-100].astype(np.float32))
    with pytest.raises(SpecError, match="against itself"):
        check_repeated([one], [shorter])
    nudged = one.samples.copy()
    nudged[0, 0] += 1e-3
    check_repeated([one, replace(one, samples=nudged)], [replace(one, samples=-one.samples)])


def test_silence_is_left_to_the_sensor_gate() -> None:
    one = recording(seconds=0.1)
    dead = replace(one, samples=np.zeros_like(one.samples))
    check_repeated([dead], [dead])
