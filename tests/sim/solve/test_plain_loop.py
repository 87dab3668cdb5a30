"""The compiled loop and its plain twin take the same steps to the same state."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.presets import names, preset
from sim.solve.plain_loop import plain_advance, plain_run
from sim.terms.backlash import lightly_loaded
from tests.strategies.running import drive
from tests.strategies.systems import every_term_machine, with_terms

STEP_S, STEPS = 1.0 / 60_000.0, 40
PARTING = with_terms(lightly_loaded(preset("gear-pair")), TermSpec(term="backlash", site="mesh1"))
MACHINES = {name: preset(name) for name in names()} | {"every term": every_term_machine(), "parting flanks": PARTING}


def run_both(name, *, rtol=1e-8):
    system = assemble(MACHINES[name])
    compiled = drive(system, step_s=STEP_S, steps=STEPS, rtol=rtol)
    plain = plain_run(system, STEP_S, rtol=rtol)
    for k in range(STEPS):
        plain_advance(plain, k)
    return compiled, plain, len(system.dofs)


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_same_motion(name):
    compiled, plain, n = run_both(name)
    final = compiled.states[-1]
    for part in (slice(0, n), slice(n, 2 * n)):
        difference = np.max(np.abs(final[part] - plain.state[part]))
        assert difference <= 1e-12 * np.max(np.abs(plain.state[part]))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper-demo", "parting flanks"])
def test_same_decisions_where_contact_opens_or_closes(name):
    compiled, plain, _ = run_both(name)
    assert plain.rejected > 0
    assert compiled.counts[3] == plain.rejected
