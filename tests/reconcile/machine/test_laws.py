"""Force laws to try: their formulas, their sizes, the machines that have them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import AtlasPlan, Offsets, Point
from reconcile.machine.laws import LAWS, SHARES, Motion, TrialLaw, label, motions, trial_plan, with_law
from sim import presets
from sim.assembly.assemble import assemble
from sim.core.spec import MachineSpec

X = np.linspace(-3e-6, 3e-6, 601)
V = 4e-3 * np.cos(np.linspace(0.0, 7.0, X.size))
MOTION = Motion(x=X, v=V, stiffness_n_per_m=6e7)
BY_KEY = {law.key: law for law in LAWS}


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return presets.preset("paper-lightly-damped")


@pytest.mark.parametrize("law", LAWS, ids=[law.key for law in LAWS])
def test_the_formula_is_the_law(law: TrialLaw) -> None:
    words = {"x": X, "v": V, "abs": np.abs, "sign": np.sign, "max": np.maximum, "min": np.minimum}
    told = eval(law.formula.format(g=f"{MOTION.gap_m:.9g}"), {"__builtins__": {}}, words)
    assert np.allclose(told, law.values(X, V, MOTION.gap_m), rtol=1e-6, atol=1e-30)


@pytest.mark.parametrize("law", LAWS, ids=[law.key for law in LAWS])
def test_a_size_is_the_share_of_the_spring(law: TrialLaw) -> None:
    force = MOTION.coefficient(law, 0.5) * law.values(X, V, MOTION.gap_m)
    assert np.std(force) == pytest.approx(0.5 * 6e7 * np.std(X))


def test_a_law_acts_on_both_axes_of_a_support(machine: MachineSpec) -> None:
    laws, terms = with_law(machine, BY_KEY["drag"], "bearing2", MOTION, 2.5e5)
    assert [law.dof for law in laws] == ["bearing2.outer.x", "bearing2.outer.y"]
    assert all(law.expression == "250000*abs(v)*v" for law in laws)
    first = len(machine.custom_laws) + 1
    assert [t.parameters["law"] for t in terms] == [first, first + 1]
    assert label(BY_KEY["drag"], "bearing2") == "drag@bearing2"


def test_every_draw_has_its_own_size_of_the_law(machine: MachineSpec) -> None:
    zero = Offsets(values=np.zeros(0))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=(zero,) * 3, twins=(zero,) * 3, draws=(), seed=0)
    law = BY_KEY["dead_zone"]
    tried = trial_plan(plan, {"bearing1": MOTION}, law, "bearing1")
    assert len(tried.draws) == len(SHARES)
    coefficients = []
    for draw in tried.draws:
        member = tried.member(draw, Point(speed_hz=30.0))
        own = member.machine.terms[-2:]
        laws = [member.machine.custom_laws[int(t.parameters["law"]) - 1] for t in own]
        assert [w.dof for w in laws] == ["bearing1.outer.x", "bearing1.outer.y"]
        coefficients.append(float((laws[0].expression or "").split("*")[0]))
        assemble(member.machine)
    assert coefficients == pytest.approx([MOTION.coefficient(law, s) for s in SHARES], rel=1e-4)


def test_supports_move_and_those_that_do_not_are_left_out(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    def still(_machine: MachineSpec, *, channels: list[str], **_how: object) -> SimpleNamespace:
        rows = np.array([np.sin(np.arange(200.0)) * (1e-6 if "bearing1" in c else 0.0) for c in channels])
        return SimpleNamespace(signals=rows)

    monkeypatch.setattr("reconcile.machine.laws.simulate", still)
    found = motions(machine, ("bearing1", "bearing2"), 0)
    assert list(found) == ["bearing1"]
    assert found["bearing1"].gap_m == pytest.approx(1e-6 / np.sqrt(2), rel=0.02)


@pytest.mark.slow
def test_the_paper_s_supports_move_by_micrometres(machine: MachineSpec) -> None:
    found = motions(machine, ("bearing1",), 0)["bearing1"]
    assert 1e-9 < found.gap_m < 1e-4
    assert float(np.std(found.v)) > 2 * np.pi * 10.0 * found.gap_m, "mesh and its harmonics, faster than the shaft"
