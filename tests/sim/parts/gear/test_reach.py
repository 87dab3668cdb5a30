"""Rows and layers of the tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sim.core.errors import SpecError
from sim.parts.gear.pair_table import legal_errors_m
from sim.parts.gear.reach import LAYERS, TILT_LIMIT_RAD, TILT_STEP_RAD, covering_errors_m, covering_tilts_rad


def test_small_play_keeps_a_tenth_of_the_module(paper_pair):
    pair = paper_pair()
    assert np.array_equal(covering_errors_m(pair, 1.9e-4), legal_errors_m(pair, 2e-4, 33))


def test_larger_play_is_covered_in_the_same_steps(paper_pair):
    errors = covering_errors_m(paper_pair(), 4.1e-4)
    assert np.diff(errors) == pytest.approx(2e-4 / 16)
    assert np.any(errors == 0.0)
    assert errors[-1] >= 4.1e-4
    assert errors[0] <= -4.1e-4


def test_it_ends_where_the_contact_ratio_reaches_one(paper_pair):
    pair = paper_pair()
    errors = covering_errors_m(pair, 5e-3)
    step = errors[1] - errors[0]
    assert 1.0 <= pair.contact(errors[-1]).contact_ratio < 1.02
    with pytest.raises(SpecError, match="contact ratio"):
        pair.contact(errors[-1] + step)
    with pytest.raises(SpecError):
        pair.contact(errors[0] - step)


def test_a_side_that_interference_cuts_short_does_not_shorten_the_other(paper_pair):
    pair = paper_pair()
    small = replace(pair, pinion=replace(pair.pinion, teeth=17, bore_radius_m=5e-3))
    errors = covering_errors_m(small, 0.0)
    with pytest.raises(SpecError, match="interference"):
        small.contact(-2e-4)
    assert -2e-4 < errors[0] <= 0.0
    assert errors[-1] == pytest.approx(2e-4)
    assert 0.0 in errors


def test_tilts_cover_and_end():
    assert covering_tilts_rad(0.0) == pytest.approx(np.linspace(-5e-4, 5e-4, 21))
    assert covering_tilts_rad(1.01e-3)[-1] == pytest.approx(1.05e-3)
    far = covering_tilts_rad(1.0)
    assert far.size == LAYERS
    assert far[-1] == pytest.approx(TILT_LIMIT_RAD)
    assert 0.0 in far
    assert np.diff(covering_tilts_rad(8e-4)) == pytest.approx(TILT_STEP_RAD)
