"""Intervals of the evidence cover what a second recording of the same machine says."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.judge.scatter import evidence_intervals
from reconcile.judge.screen import judge
from reconcile.judge.space import fit_space
from tests.reconcile.judge.made import EFFECTS, FEATURES, MEASURED_DB, changes, library, world

MADE = world()


@pytest.mark.slow
def test_the_interval_is_that_of_recording_again() -> None:
    rng = np.random.default_rng(3)
    truth = MADE.effect(1, 0.6, rng) + MADE.healthy(rng, 1)[0]
    seen = [truth + rng.normal(0.0, MEASURED_DB, FEATURES) for _ in range(60)]
    here = changes(MADE, seen[0])
    fitted = fit_space(here, library(MADE), seed=1)
    evidence = np.array([judge((fitted,), s).evidence for s in seen])
    low, high = evidence_intervals((fitted,), here, evidence[0], seed=5)
    spread = np.quantile(evidence, 0.95, axis=0) - np.quantile(evidence, 0.05, axis=0)
    np.testing.assert_allclose(high - low, spread, rtol=0.5)
    assert (low < evidence[0]).all() and (evidence[0] < high).all()
    assert len(low) == len(EFFECTS)


def test_louder_noise_widens_it_and_a_seed_repeats_it() -> None:
    rng = np.random.default_rng(4)
    here = changes(MADE, MADE.effect(0, 0.8, rng))
    fitted = fit_space(here, library(MADE), seed=1)
    evidence = judge((fitted,), here.observed).evidence
    usual = evidence_intervals((fitted,), here, evidence, seed=5)
    np.testing.assert_array_equal(usual, evidence_intervals((fitted,), here, evidence, seed=5))
    louder = type(here)(**{**here.__dict__, "measured": 3.0 * here.measured})
    wide = evidence_intervals((fitted,), louder, evidence, seed=5)
    assert (wide[1] - wide[0] > usual[1] - usual[0]).all()
