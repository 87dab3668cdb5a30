"""Effects at bearings in the corners of their parameters: finite signals or a clear refusal, at every bearing."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from sim.core.errors import SpecError
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.strategies.systems import with_terms

KEYS = (
    "ball_spall",
    "bearing_stiffness",
    "cage_slip",
    "inner_spall",
    "inner_waviness",
    "outer_spall",
    "outer_waviness",
    "radial_clearance",
    "ring_creep",
    "squeeze_film",
)


def corners(term):
    """Defaults, and all combinations of lowest and highest: the severity not zero, phases and angles at one value."""
    ends = [
        (p.default,) if p.unit == "rad" else tuple(v for v in (p.low, p.high) if v != 0.0 or p.name != term.severity)
        for p in term.params
    ]
    return [{}, *(dict(zip([p.name for p in term.params], values, strict=True)) for values in product(*ends))]


@pytest.mark.slow
@pytest.mark.parametrize("machine", ["rotor", "paper", "paper-lightly-damped"])
@pytest.mark.parametrize("key", KEYS)
def test_corners_end_in_finite_signals_or_a_refusal(key, machine):
    plain, ran = preset(machine), 0
    for values in corners(REGISTRY.get(key)):
        # without its pitch diameter a spall takes the bearing's own
        bare = {k: v for k, v in values.items() if k != "pitch_diameter"}
        for given in (values, bare) if bare != values else (values,):
            for bearing in plain.bearings[:: max(1, len(plain.bearings) // 2)]:
                spec = with_terms(plain, TermSpec(term=key, site=bearing.name, parameters=given))
                try:
                    run = simulate(
                        spec, duration_s=0.05, output_rate_hz=12_000.0, settings=Settings(estimate_error=False)
                    )
                except SpecError as refusal:
                    assert key.endswith("spall")
                    assert all(p.allowed and p.field for p in refusal.problems)
                    continue
                ran += 1
                assert np.all(np.isfinite(run.signals)), given
                assert run.quality.unconverged_steps == 0, given
    assert ran > 0
