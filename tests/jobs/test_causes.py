"""Causes shown by counterfactual runs of the paper's gearbox and a rotor, and the impacts beside them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jobs.analysis import analyse
from jobs.carry_out import CAUSES, IMPACTS, carry_out, completed
from jobs.causes import MAX_RUNS, further_runs, plan_causes, with_causes
from jobs.counterfactuals import active_terms, base_excitations, idle_terms, without
from jobs.documents import ResultDocuments
from jobs.labelling import label_stored
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from jobs.resolve import resolve
from jobs.results import ResultReader, write_result
from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.errors import Cancelled, SpecError
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from store.artefacts.folder import FolderStore

ENGINE = PhysicsEngine()
SENSORS = [f"resonator{i}.y.acceleration" for i in (1, 2)]
RUNOUT = TermSpec(term="eccentricity", site="pinion", parameters={"radius": 2e-5})
CLEARANCE = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 2e-5})
SERIES = TermSpec(term="fit_clearance_series", site="bearing1", parameters={"gap": 2e-5})
NOTHING = TermSpec(term="eccentricity", site="gear", parameters={"radius": 0.0})


def machine(*terms: TermSpec, base: str = "paper-lightly-damped") -> MachineSpec:
    return preset(base).model_copy(update={"terms": list(terms)})


def ask(spec: MachineSpec, **more: object) -> SimulationRequest:
    body = {"machine": spec, "duration_s": 1.0, "sampling_rate_hz": 20_000.0, "causes": True}
    body |= {"channels": SENSORS if "resonator1" in str(spec.resonators) else None} | more
    return SimulationRequest.model_validate(body)


@cache
def _done(key: str, base: str) -> tuple[Response, ResultDocuments]:
    known = {"runout": RUNOUT, "clearance": CLEARANCE, "nothing": NOTHING, "series": SERIES}
    spec = machine(*(known[name] for name in key.split()), base=base)
    told: list[float] = []
    outcome = carry_out(ENGINE, spec, ask(spec), progress=told.append, cancelled=lambda: False)
    assert told == sorted(told) and told[-1] == 1.0, "progress goes through all runs"
    documents = completed(analyse(outcome.response, discard_transient=True), outcome.extras)
    return outcome.response, documents


def peaks(key: str, base: str = "paper-lightly-damped") -> dict[str, Mapping[str, Any]]:
    _, documents = _done(key, base)
    listed = documents.peaks["peaks"]
    assert isinstance(listed, list)
    return {p["label"]: p for p in listed if p["label"]}


def share(peak: Mapping[str, Any], term: str, site: str) -> float:
    return sum(c["share"] for c in peak["causes"] if (c["term"], c["site"]) == (term, site))


def test_plan_and_cost() -> None:
    plan = plan_causes(machine(RUNOUT, CLEARANCE, NOTHING))
    assert [e.counterfactual for e in plan.effects] == ["severity_zero", "removed"]
    assert [(e.term, e.site) for e in plan.idle] == [("eccentricity", "gear")]
    assert plan.rule == "shapley_power" and len(plan.coalitions) == 3
    # one mesh's stiffness and transmission error, four bearings
    assert plan.runs == 3 + 6
    spec = machine(RUNOUT, CLEARANCE)
    alone = resolve(ask(spec, causes=False), ENGINE, Limits()).cost
    shown = resolve(ask(spec), ENGINE, Limits()).cost
    assert shown.steps == 10 * alone.steps and shown.seconds == pytest.approx(10 * alone.seconds)
    with pytest.raises(SpecError, match="steps"):
        resolve(ask(spec), ENGINE, Limits(steps=9 * alone.steps))


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


def test_cancelling_ends_all_runs() -> None:
    spec = machine(RUNOUT)
    told: list[float] = []
    with pytest.raises(Cancelled):
        carry_out(ENGINE, spec, ask(spec), progress=told.append, cancelled=lambda: bool(told) and told[-1] > 0.3)
    assert 0.3 < told[-1] < 0.6


@pytest.mark.slow
def test_run_out_alone_causes_its_sidebands() -> None:
    for label in ("1*f_m-1*f_r1", "1*f_m+1*f_r1", "2*f_m+1*f_r1"):
        peak = peaks("runout")[label]
        assert share(peak, "eccentricity", "pinion") > 0.9, label
        first = peak["causes"][0]
        assert first["removed_db"] > 30 and first["counterfactual"] == "severity_zero"
        assert (peak["mechanism"], peak["component"]) == ("eccentricity", "pinion")
        assert peak["mechanism_basis"] == "counterfactual"
    assert share(peaks("runout")["1*f_m"], "eccentricity", "pinion") < 0.02
    assert share(peaks("runout")["1*f_m"], "transmission_error", "mesh1") > 0.9


@pytest.mark.slow
def test_clearance_alone_causes_the_ball_pass_lines() -> None:
    for k in (1, 2, 3, 4, 5):
        peak = peaks("clearance")[f"{k}*f_o1"]
        # the fourth is the strongest of the healthy bearings' own: they keep a sixth of it
        assert share(peak, "fit_clearance", "bearing1") > (0.8 if k == 4 else 0.9), k
        assert peak["causes"][0]["counterfactual"] == "removed"
        assert peak["component"] == "bearing1", "the counterfactual decides between two equal bearings"


@pytest.mark.slow
def test_both_together_get_each_its_own_and_nothing_gets_nothing() -> None:
    found = peaks("runout clearance nothing")
    for label in ("1*f_m-1*f_r1", "1*f_m+1*f_r1"):
        assert share(found[label], "eccentricity", "pinion") > 0.9
        assert share(found[label], "fit_clearance", "bearing1") < 0.05
    for k in (1, 2, 3):
        assert share(found[f"{k}*f_o1"], "fit_clearance", "bearing1") > 0.9
        assert share(found[f"{k}*f_o1"], "eccentricity", "pinion") < 0.05
    for peak in found.values():
        if peak["causes"]:
            idle = next(c for c in peak["causes"] if c["site"] == "gear")
            assert (idle["share"], idle["removed_db"]) == (0.0, 0.0)
            # what is below the list's limit is left out
            assert 0.95 < sum(c["share"] for c in peak["causes"]) < 1.001
    _, documents = _done("runout clearance nothing", "paper-lightly-damped")
    assert documents.peaks["cause_rule"] == "shapley_power"
    cost = documents.peaks["cause_cost"]
    assert isinstance(cost, Mapping) and cost["runs"] == 9 and cost["steps"] > 9 * 60_000


@pytest.mark.slow
def test_asking_for_causes_changes_nothing_else(tmp_path: Path) -> None:
    spec = machine(CLEARANCE)
    plain = carry_out(ENGINE, spec, ask(spec, causes=False), progress=lambda _: None, cancelled=lambda: False)
    response, documents = _done("clearance", "paper-lightly-damped")
    assert plain.extras == {}
    assert np.array_equal(plain.response.signals, response.signals)
    assert plain.response.channels == response.channels and plain.response.quality == response.quality
    store = FolderStore(tmp_path)
    write_result(store, "j/1", attempt=1, response=response, documents=documents, expires_at=None)
    reader = ResultReader(store, "j/1")
    assert reader.has(CAUSES) and reader.has(IMPACTS) and not reader.has("signals")
    second = response.channels[1].name
    labels = with_causes(label_stored(reader, second, spec), reader.document(CAUSES), second)
    listed = labels["peaks"]
    assert isinstance(listed, list)
    assert any(c["share"] > 0.5 for p in listed for c in p["causes"])
    again = with_causes(label_stored(reader, response.channels[0].name, spec), reader.document(CAUSES), "nothing")
    assert isinstance(again["peaks"], list) and not any(p["causes"] for p in again["peaks"])


def contacts(documents: ResultDocuments) -> dict[str, Mapping[str, Any]]:
    listed = documents.extras[IMPACTS]["contacts"]
    assert isinstance(listed, list)
    return {c["contact"]: c for c in listed}


@pytest.mark.slow
def test_a_loose_ring_is_pressed_once_a_ball_pass() -> None:
    """A rotor under its weight with one loose bearing: its ring never leaves the bore, each ball presses it once."""
    gap = CLEARANCE.model_copy(update={"parameters": {"gap": 1e-6}})
    spec = machine(gap, base="rotor")
    names = ["bearing1.outer.y.acceleration", "bearing1.wall.contact", "bearing1.wall.normal_force"]
    request = ask(spec, channels=names, causes=False, duration_s=2.0)
    outcome = carry_out(ENGINE, spec, request, progress=lambda _: None, cancelled=lambda: False)
    (wall,) = outcome.extras[IMPACTS]["contacts"]  # type: ignore[misc]  # recorded outputs are enough
    assert wall["counts"]["impact"] == 0 and wall["counts"]["surge"] > 80
    folds = {f["base"]: f for f in wall["folds"]}
    assert folds["f_o1"]["per_period"] == pytest.approx(1.0, abs=0.02)
    assert folds["f_o1"]["coherence"] > 0.95 and folds["f_o1"]["locked"]
    assert not folds["f_r1"]["locked"] and folds["f_r1"]["coherence"] < 0.1
    assert folds["f_c1"]["per_period"] == pytest.approx(9.0, abs=0.2), "nine balls a turn of the cage"
    times = np.array([e["time_s"] for e in wall["events"]])
    # the second half, when the start has died away
    late = np.diff(times[times > 1.0])
    assert late == pytest.approx(1 / outcome.response.bases_hz["f_o1"], rel=0.05)


@pytest.mark.slow
def test_in_the_gearbox_every_tooth_presses_the_loose_ring() -> None:
    _, documents = _done("clearance", "paper-lightly-damped")
    wall, mesh = contacts(documents)["bearing1.wall"], contacts(documents)["mesh1"]
    folds = {f["base"]: f for f in wall["folds"]}
    assert folds["f_m"]["per_period"] == pytest.approx(1.0, abs=0.02) and folds["f_m"]["coherence"] > 0.99
    assert wall["counts"]["impact"] == mesh["counts"]["impact"] == 0, "the load keeps ring and flanks in contact"
    summary = documents.summary["impacts"]
    assert isinstance(summary, Mapping) and "f_m" in summary["bearing1.wall"]["keeps_time_with"]


@pytest.mark.slow
def test_a_wide_clearance_strikes_and_each_strike_begins_with_a_touch() -> None:
    spec = machine(CLEARANCE.model_copy(update={"parameters": {"gap": 5e-5}}))
    names = ["resonator1.y.acceleration", "bearing1.wall.contact", "bearing1.wall.normal_force"]
    outcome = carry_out(
        ENGINE, spec, ask(spec, channels=names, causes=False), progress=lambda _: None, cancelled=lambda: False
    )
    (wall,) = outcome.extras[IMPACTS]["contacts"]  # type: ignore[misc]
    counts = wall["counts"]
    assert abs(counts["touch"] - counts["release"]) <= 1
    assert counts["impact"] > 0.9 * counts["touch"] > 500
    assert 0.1 < wall["contact_share"] < 0.5 and outcome.response.contact_share["bearing1.wall"] < 0.5
    assert {f["base"] for f in wall["folds"] if f["locked"]} == {"f_m"}


@pytest.mark.slow
def test_flanks_that_part_strike_again() -> None:
    """Backlash and a light torque: the mesh rattles."""
    spec = machine()
    meshes = [m.model_copy(update={"backlash_m": 5e-5}) for m in spec.meshes]
    loads = [load.model_copy(update={"torque_nm": 0.5}) for load in spec.loads]
    spec = spec.model_copy(update={"meshes": meshes, "loads": loads})
    names = ["resonator1.y.acceleration", "mesh1.contact", "mesh1.force"]
    outcome = carry_out(
        ENGINE, spec, ask(spec, channels=names, causes=False), progress=lambda _: None, cancelled=lambda: False
    )
    (mesh,) = outcome.extras[IMPACTS]["contacts"]  # type: ignore[misc]
    assert mesh["counts"]["touch"] > 100 and mesh["counts"]["impact"] > 50
    assert mesh["contact_share"] < 0.9
