"""Every compiled kernel equals its interpreted twin, mode by mode, on random states."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.elements import OUT_ENERGY, STAGES
from sim.presets import names, preset
from sim.solve.plain import interpreted, plain_context, plain_force
from tests.strategies.kernels import compiled_context, compiled_force, trials
from tests.strategies.systems import every_term_machine

MACHINES = {name: preset(name) for name in names()} | {"every term": every_term_machine()}
TOLERANCE = 1e-12


def close(a, b, tolerance=TOLERANCE):
    scale = np.max(np.abs(b)) if np.size(b) else 0.0
    return bool(np.all(np.abs(np.asarray(a) - b) <= tolerance * scale))


def conditioning(trial):
    """Rounding of the shaft angle over the angle of one step: what averages over a step cannot know better."""
    turned = trial.shafts[0, -1] - trial.shafts[0, 0]
    return 8.0 * np.finfo(float).eps * trial.shafts[0, -1] / turned if turned > 0 else 0.0


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_contexts_agree(name):
    system = assemble(MACHINES[name])
    for element in system.elements:
        for trial in trials(system, element, count=4):
            plain = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)
            compiled = compiled_context(element, trial)
            for column in range(element.context):
                allowed = TOLERANCE + conditioning(trial)
                assert close(compiled[:, column], plain[:, column], allowed), (element.name, column)


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.parametrize("name", MACHINES)
def test_forces_agree(name, mode):
    system = assemble(MACHINES[name])
    for element in system.elements:
        for trial in trials(system, element, count=4):
            context = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)
            row = context[STAGES] if mode == 2 and element.exact_end else context[0]
            plain = plain_force(element, mode, trial.u, trial.ud, row)
            force, out = compiled_force(element, mode, trial.u, trial.ud, row)
            assert close(force, plain.force), element.name
            if mode == 1:
                tangent = np.concatenate([plain.stiffness, plain.damping]).ravel()
                # slices of a whole face cancel in their tilting moment: what is left of 1e8 N/m is rounding
                cancelled = bool(np.max(np.abs([tangent, out[: tangent.size]])) < 1e-9)
                assert cancelled or close(out[: tangent.size], tangent), element.name
            if mode == 2:
                for k in range(OUT_ENERGY + len(element.outputs)):
                    assert close(out[k], plain.outputs[k]), (element.name, k)


@pytest.mark.parametrize("name", MACHINES)
def test_the_force_does_not_depend_on_the_mode(name):
    system = assemble(MACHINES[name])
    for element in system.elements:
        for trial in trials(system, element, count=3):
            row = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)[0]
            assert close(
                plain_force(element, 1, trial.u, trial.ud, row).force,
                plain_force(element, 0, trial.u, trial.ud, row).force,
            )


def test_a_twin_holds_nothing_compiled():
    for element in assemble(MACHINES["every term"]).elements:
        waiting, seen = [interpreted(element.kernel.prepare), interpreted(element.kernel.force)], set()
        while waiting:
            function = waiting.pop()
            seen.add(function)
            for name in function.__code__.co_names:
                value = function.__globals__.get(name)
                assert not hasattr(value, "py_func"), f"{function.__name__} calls compiled {name}"
                if callable(value) and hasattr(value, "__code__") and value not in seen:
                    waiting.append(value)
