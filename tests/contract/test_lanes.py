"""Every effect in lanes equals itself alone: the same source, compiled twice, decided lane by lane."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from tests.contract.shown import demo_machines
from tests.strategies.systems import every_term_machine

QUICK = Settings(estimate_error=False)
SPAN = {"duration_s": 0.006, "output_rate_hz": 20_000.0}
"""Short enough that impacts have not yet blown up the rounding by which two runs differ."""


@pytest.mark.slow
@pytest.mark.parametrize("key", [t.key for t in REGISTRY if t.params])
def test_a_lane_with_the_effect_equals_the_single_run(key):
    term = REGISTRY.get(key)
    assert term is not None
    machine, _ = demo_machines(term)
    single = simulate(machine, settings=QUICK, **SPAN)
    weaker = machine.model_copy(
        update={"terms": tuple(_weaker(t, term.severity) if t.term == key else t for t in machine.terms)}
    )
    members = [Member(machine=weaker), Member(machine=machine)]
    found = simulate_many(members, settings=QUICK, **SPAN)[1]
    assert isinstance(found, Response)
    size = np.max(np.abs(single.signals))
    np.testing.assert_allclose(found.signals, single.signals, atol=1e-9 * size)


@pytest.mark.slow
def test_a_lane_with_every_effect_at_once_equals_the_single_run():
    machine = every_term_machine()
    single = simulate(machine, settings=QUICK, **SPAN)
    (found,) = simulate_many([Member(machine=machine)], settings=QUICK, **SPAN)
    assert isinstance(found, Response)
    np.testing.assert_allclose(found.signals, single.signals, atol=1e-9 * np.max(np.abs(single.signals)))


def _weaker(spec: TermSpec, severity: str | None) -> TermSpec:
    """Half the effect, so that the neighbouring lane is another machine."""
    values = dict(spec.parameters)
    if severity in values:
        values[severity] *= 0.5
    return spec.model_copy(update={"parameters": values})
