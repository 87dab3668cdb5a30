"""The tangent every element gives equals finite differences of its force."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.plain import plain_context, plain_force
from tests.strategies.kernels import trials
from tests.strategies.systems import every_term_machine, with_terms

MACHINES = {
    "every term": every_term_machine(),
    "gear-pair": preset("gear-pair"),
    "preload": with_terms(preset("paper-demo"), TermSpec(term="pitch_error", site="gear")),
}
STEP_U, STEP_UD = 1e-10, 1e-9
PART_N = 1e3
"""Load of a slice or a ball at these states, N: forces that are sums of such know no better than its rounding."""


def difference(element, u, ud, row, k, *, rate):
    step = STEP_UD if rate else STEP_U
    sides = []
    for sign in (1.0, -1.0):
        du = np.zeros(element.size)
        du[k] = sign * step
        shifted = (u, ud + du) if rate else (u + du, ud)
        sides.append(plain_force(element, 0, *shifted, row).force)
    return (sides[0] - sides[1]) / (2.0 * step)


@pytest.mark.parametrize("name", MACHINES)
def test_tangent(name):
    system = assemble(MACHINES[name])
    for element in system.elements:
        for trial in trials(system, element, count=8):
            row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
            tangent = plain_force(element, 1, trial.u, trial.ud, row)
            for given, rate in ((tangent.stiffness, False), (tangent.damping, True)):
                found = np.column_stack(
                    [difference(element, trial.u, trial.ud, row, k, rate=rate) for k in range(element.size)]
                )
                scale = np.max(np.abs(given)) if given.size else 0.0
                rounding = 4.0 * np.spacing(max(np.max(np.abs(tangent.force)), PART_N)) / (STEP_UD if rate else STEP_U)
                assert found == pytest.approx(given, abs=2e-4 * scale + 1e-6 + rounding), (element.name, rate)
