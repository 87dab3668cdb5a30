"""All effects of rotors and supports on one machine: compiled, interpreted and in lanes they are the same."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.elements import OUT_ENERGY
from sim.core.response import Response
from sim.core.spec import CustomLaw, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.plain import plain_context, plain_force
from sim.solve.settings import ENERGY_LIMIT, Settings
from tests.strategies.kernels import compiled_context, compiled_force, trials
from tests.strategies.systems import with_terms

LAWS = [
    CustomLaw(name="stop", dof="bearing4.outer.y", expression="1e7*max(x-1e-6,0)^1.5+20*tanh(v/0.02)*cos(phi)"),
    CustomLaw(name="hook", dof="gear.theta", against="output.theta", expression="2*x^3/(1+x^2)+exp(-x)-1"),
]
PLACES = (
    ("unbalance", "pinion", {"moment": 1e-4}),
    ("bent_shaft", "gear", {}),
    ("parallel_misalignment", "input", {"odd": 0.5}),
    ("angular_misalignment", "output", {"angle": 0.1}),
    ("torque_ripple", "input", {}),
    ("coupling_nonlinearity", "input", {}),
    ("coupling_backlash", "output", {}),
    ("shaft_crack", "bearing1", {"cross": 0.3}),
    ("pedestal_looseness", "bearing3", {"lift": -1e-6}),
    ("rub", "pinion", {"gap": 3e-6}),
    ("support_mode", "bearing2", {}),
    ("gravity", "input", {}),
    ("custom_force", "bearing4", {"law": 1.0}),
    ("custom_force", "output", {"law": 2.0}),
)


def machine_of(scale: float = 1.0):
    """The gearbox with all of them; `scale` changes numbers but no structure."""
    base = preset("paper-lightly-damped").model_copy(update={"custom_laws": LAWS})
    terms = []
    for key, site, values in PLACES:
        changed = {"moment": 1e-4 * scale} if key == "unbalance" else {}
        changed |= {"scale": scale} if key == "custom_force" else {}
        terms.append(TermSpec(term=key, site=site, parameters=values | changed))
    return with_terms(base, *terms)


NAMES = [e.name for e in assemble(machine_of()).elements if e.name not in {"mesh1", *(f"bearing{k}" for k in range(5))}]


def close(a, b, tolerance):
    return bool(np.all(np.abs(np.asarray(a) - b) <= tolerance * (np.max(np.abs(b)) if np.size(b) else 0.0)))


@pytest.mark.parametrize("name", NAMES)
def test_compiled_kernels_equal_their_interpreted_twins(name):
    system = assemble(machine_of())
    element = next(e for e in system.elements if e.name == name)
    for trial in trials(system, element, count=6):
        context = plain_context(element, trial.step, trial.shafts, trial.u, trial.ud)
        compiled = compiled_context(element, trial)
        assert close(compiled[:, : min(element.context, 6)], context[:, : min(element.context, 6)], 1e-11)
        for mode in (0, 1, 2):
            plain = plain_force(element, mode, trial.u, trial.ud, context[0].copy())
            force, out = compiled_force(element, mode, trial.u, trial.ud, context[0].copy())
            assert close(force, plain.force, 1e-12)
            if mode == 1:
                tangent = np.concatenate([plain.stiffness, plain.damping]).ravel()
                assert close(out[: tangent.size], tangent, 1e-11)
            if mode == 2:
                count = OUT_ENERGY + len(element.outputs)
                assert close(out[:count], plain.outputs, 1e-12)


@pytest.mark.slow
def test_lanes_equal_single_runs_and_energy_closes():
    run = {"duration_s": 0.03, "output_rate_hz": 20_000.0, "settings": Settings(estimate_error=False)}
    machines = [machine_of(scale) for scale in (1.0, 0.5, 1.7)]
    lanes = simulate_many([Member(machine=m) for m in machines], **run)
    for machine, lane in zip(machines, lanes, strict=True):
        single = simulate(machine, **run)
        assert isinstance(lane, Response)
        assert lane.signals == pytest.approx(single.signals, abs=1e-9 * np.max(np.abs(single.signals)))
        assert single.quality.unconverged_steps == 0
        assert single.quality.energy.relative_residual < ENERGY_LIMIT


def test_the_internal_ones_exert_no_net_force():
    system = assemble(machine_of())
    for name in ("gear.bow", "bearing1.crack", "output.joint.bending", "output.joint.twist", "output.custom.hook"):
        element = next(e for e in system.elements if e.name == name)
        for coordinate in element.coordinates:
            assert sum(weight for _, weight in coordinate.weights) == pytest.approx(0.0, abs=1e-15)
