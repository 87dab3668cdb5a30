"""Impacts of a rotor's loose ring, of the gearbox's, and of rattling flanks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from jobs.carry_out import IMPACTS, carry_out
from jobs.documents import ResultDocuments
from tests.jobs.gearbox_runs import CLEARANCE, ENGINE, SHARED, ask, done, machine


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
@SHARED
def test_in_the_gearbox_every_tooth_presses_the_loose_ring() -> None:
    _, documents = done("clearance", "paper-lightly-damped")
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
