"""Causes shown by counterfactual runs of the paper's gearbox."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from jobs.carry_out import CAUSES, IMPACTS, carry_out
from jobs.causes import with_causes
from jobs.labelling import label_stored
from jobs.results import ResultReader, write_result
from store.artefacts.folder import FolderStore
from tests.jobs.gearbox_runs import CLEARANCE, ENGINE, SHARED, ask, done, machine, peaks, share


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
def test_every_line_of_the_base_machine_has_an_element_that_makes_it() -> None:
    """The third mesh harmonic is left by either excitation of the mesh; both take it away."""
    for label in ("1*f_m", "2*f_m", "3*f_m", "4*f_m"):
        told = peaks("nothing")[label]["causes"]
        mesh = sum(c["share"] for c in told if c["site"] == "mesh1" and c["counterfactual"] != "predicted")
        assert mesh > 0.6, (label, told)
        assert not [c for c in told if c["counterfactual"] == "predicted" and c["share"] > 0.05]
    for label, peak in peaks("nothing", "gear-pair").items():
        # beats of the mesh with the step of the integration are told as such and have no cause in the machine
        if peak["amplitude"] and not label.endswith("*f_s"):
            assert sum(c["share"] for c in peak["causes"] if c["site"] == "mesh1") > 0.95


def test_what_weakens_a_line_is_not_its_mechanism() -> None:
    def told(removed_db: float) -> Mapping[str, object]:
        cause = {"term": "te", "site": "m1", "counterfactual": "amplitude_zero", "removed_db": removed_db, "share": 0.9}
        peak = {"label": "3*f_m", "mechanism": "mesh_total", "mechanism_basis": "predicted", "component": "mesh1"}
        table = {"x": {"amplitude": {"3*f_m": [cause]}}}
        document = {"channels": table, "rule": "shapley_power", "cost": {}}
        listed = with_causes({"peaks": [peak], "envelope": None}, document, "x")["peaks"]
        assert isinstance(listed, list) and listed[0]["causes"] == [cause]
        return dict(listed[0])

    grows, falls = told(-2.89), told(20.0)
    assert (grows["mechanism"], grows["mechanism_basis"], grows["component"]) == ("mesh_total", "predicted", "mesh1")
    assert (falls["mechanism"], falls["mechanism_basis"], falls["component"]) == ("te", "counterfactual", "m1")


@pytest.mark.slow
@SHARED
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
    _, documents = done("runout clearance nothing", "paper-lightly-damped")
    assert documents.peaks["cause_rule"] == "shapley_power"
    cost = documents.peaks["cause_cost"]
    assert isinstance(cost, Mapping) and cost["runs"] == 12 and cost["steps"] > 12 * 60_000


@pytest.mark.slow
@SHARED
def test_asking_for_causes_changes_nothing_else(tmp_path: Path) -> None:
    spec = machine(CLEARANCE)
    plain = carry_out(ENGINE, spec, ask(spec, causes=False), progress=lambda _: None, cancelled=lambda: False)
    response, documents = done("clearance", "paper-lightly-damped")
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
