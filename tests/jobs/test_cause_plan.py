"""Plans of counterfactual runs: which machines, how many, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from jobs.carry_out import carry_out
from jobs.cause_plan import MAX_RUNS, further_runs, plan_causes
from jobs.causes import with_causes
from jobs.counterfactuals import active_terms, base_excitations, idle_terms, predicted_part, without
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.resolve import resolve
from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.errors import Cancelled, SpecError
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from tests.jobs.gearbox_runs import CLEARANCE, ENGINE, NOTHING, RUNOUT, SERIES, ask, machine


def test_plan_and_cost() -> None:
    plan = plan_causes(machine(RUNOUT, CLEARANCE, NOTHING))
    assert [e.counterfactual for e in plan.effects] == ["severity_zero", "removed"]
    assert [(e.term, e.site) for e in plan.idle] == [("eccentricity", "gear")]
    assert plan.rule == "shapley_power" and len(plan.coalitions) == 3
    # one mesh's stiffness and transmission error, four bearings, then both of the mesh and two pairs of equal bearings
    assert plan.runs == 3 + 6 + 3
    spec = machine(RUNOUT, CLEARANCE)
    alone = resolve(ask(spec, causes=False), ENGINE, Limits()).cost
    shown = resolve(ask(spec), ENGINE, Limits()).cost
    assert shown.steps == 13 * alone.steps and shown.seconds == pytest.approx(13 * alone.seconds)
    with pytest.raises(SpecError, match="steps"):
        resolve(ask(spec), ENGINE, Limits(steps=12 * alone.steps))


def test_pairs_that_make_the_same_lines_are_taken_away_together() -> None:
    plan = plan_causes(preset("two-stage"))
    pairs = [{(e.term, e.site) for e in (plan.excitations[i] for i in r)} for r in plan.removals if len(r) > 1]
    assert {("mesh_stiffness", "mesh2"), ("transmission_error", "mesh2")} in pairs
    assert {("ball_contact", "bearing3"), ("ball_contact", "bearing4")} in pairs  # on two gears of one shaft
    assert not [p for p in pairs if ("ball_contact", "bearing2") in p and ("ball_contact", "bearing3") in p]


@pytest.mark.slow
def test_counterfactual_runs_do_not_measure_the_step_error() -> None:
    class Spy(PhysicsEngine):
        def simulate(self, machine: MachineSpec, **options: Any) -> Response:
            response = super().simulate(machine, **options)
            told.append(response.quality.step_error)
            return response

    told: list[float | None] = []
    spec = preset("gear-pair")
    request = ask(spec, duration_s=0.1, channels=None)
    outcome = carry_out(Spy(), spec, request, progress=lambda _: None, cancelled=lambda: False)
    assert len(told) == 4 and told[0] is not None and told[1:] == [None] * 3
    assert outcome.response.quality.step_error == told[0]


def test_what_no_run_takes_away_is_told_by_prediction() -> None:
    spec = machine()
    told = [predicted_part(c, spec) for c in ("mesh1", "gear", "bearing2", "input", "")]
    parts = ["mesh_excitation", "mesh_excitation", "ball_contact", "rotation", "base_machine"]
    assert [e.term for e in told] == parts
    assert [e.site for e in told] == ["mesh1", "mesh1", "bearing2", "input", ""]
    cause = {"term": "ball_contact", "site": "bearing2", "share": 0.9, "counterfactual": "predicted"}
    document = {"rule": "", "cost": {}, "channels": {"a": {"amplitude": {"1*f_o1": [cause]}}}}
    (peak,) = with_causes({"peaks": [{"label": "1*f_o1"}]}, document, "a")["peaks"]  # type: ignore[misc]
    assert (peak["mechanism"], peak["component"], peak["mechanism_basis"]) == ("ball_contact", "bearing2", "predicted")


def test_a_request_without_causes_keeps_its_identity() -> None:
    spec = machine(RUNOUT)
    document = resolve(ask(spec, causes=False), ENGINE, Limits()).document
    assert "causes" not in document
    assert resolve(ask(spec), ENGINE, Limits()).document == {**document, "causes": True}
    assert further_runs(spec, ask(spec, causes=False)) == 0


def test_zero_of_the_papers_clearance_is_a_rigid_wall_and_acts() -> None:
    closed = machine(CLEARANCE.model_copy(update={"parameters": {"gap": 0.0}}))
    assert len(active_terms(closed)) == 1
    assert not active_terms(machine(SERIES.model_copy(update={"parameters": {"gap": 0.0}})))
    assert idle_terms(machine(NOTHING))[0].counterfactual == "severity_zero"
    # a severity left out is the default of its parameter, not zero
    assert len(active_terms(machine(RUNOUT.model_copy(update={"parameters": {}})))) == 1


def test_more_effects_than_runs_are_refused_by_name() -> None:
    slip = [TermSpec(term="cage_slip", site=f"bearing{i}", parameters={"share": 0.01}) for i in range(MAX_RUNS + 1)]
    with pytest.raises(SpecError) as caught:
        plan_causes(machine(*slip))
    assert caught.value.problems[0].field == "causes"
    some = plan_causes(machine(*slip[: MAX_RUNS - 3]))
    assert some.rule == "leave_one_out_power" and some.runs == MAX_RUNS and len(some.left_out) == 4


@pytest.mark.parametrize("effect", base_excitations(machine()), ids=lambda e: f"{e.term}@{e.site}")
def test_twins_of_the_base_machine_have_its_modes(effect) -> None:  # type: ignore[no-untyped-def]
    """Freezing, evening out, many balls: the mean stiffness stays, so the natural frequencies do."""
    own, twin = assemble(machine()), assemble(without(machine(), [effect]))
    assert natural_frequencies_hz(twin) == pytest.approx(natural_frequencies_hz(own), rel=0.02)
    assert twin.dofs == own.dofs and np.array_equal(twin.load, own.load)
    assert {c.name for c in twin.channels} == {c.name for c in own.channels}


@pytest.mark.slow
def test_cancelling_ends_all_runs() -> None:
    spec = machine(RUNOUT)
    told: list[float] = []
    with pytest.raises(Cancelled):
        carry_out(ENGINE, spec, ask(spec), progress=told.append, cancelled=lambda: bool(told) and told[-1] > 0.3)
    assert 0.3 < told[-1] < 0.6
