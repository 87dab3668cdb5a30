"""The compiled loop and its plain twin take the same steps to the same state."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.presets import names, preset
from sim.solve.plain_loop import plain_advance, plain_run
from tests.strategies.running import drive
from tests.strategies.systems import every_term_machine

STEP_S, STEPS = 1.0 / 60_000.0, 40
MACHINES = {name: preset(name) for name in names()} | {"every term": every_term_machine()}


def run_both(name, *, rtol=1e-8):
    system = assemble(MACHINES[name])
    compiled = drive(system, step_s=STEP_S, steps=STEPS, rtol=rtol)
    plain = plain_run(system, STEP_S, rtol=rtol)
    for k in range(STEPS):
        plain_advance(plain, k)
    return compiled, plain, len(system.dofs)


@pytest.mark.parametrize("name", MACHINES)
def test_same_motion(name):
    compiled, plain, n = run_both(name)
    final = compiled.states[-1]
    for part in (slice(0, n), slice(n, 2 * n)):
        difference = np.max(np.abs(final[part] - plain.state[part]))
        assert difference <= 1e-12 * np.max(np.abs(plain.state[part]))


def test_same_decisions_around_a_wall():
    compiled, plain, _ = run_both("paper-demo")
    assert plain.rejected > 0
    assert compiled.counts[3] == plain.rejected
