"""A concealed rotor from file to verdict: a pit hidden by the proof's own physics on a machine without teeth.

Small atlases stand beside the tests (`tests/proof/atlas`), so that only what belongs to the case is simulated.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from app.cli.recordings import Given, read_recording
from proof import case as made
from proof.score.one import score
from reconcile.entry import reconcile_recordings
from sim.core.spec import MachineSpec
from tests.proof.rotor import CASE, HIDDEN, NOMINATED, wanted
from tests.reconcile import prebuilt

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("proof-small")]


def test_the_small_atlases_are_what_the_simulator_gives_today() -> None:
    """One of the two is simulated: both are of one machine and one version of the physics."""
    for now in wanted():
        why = prebuilt.stale(now)
        if why is not None:
            pytest.fail(why, pytrace=False)
    found = prebuilt.deviation_db(wanted()[0], -1)
    assert max(found.values()) < prebuilt.SAME_DB, f"the physics changed (dB: {found}): {prebuilt.REMAKE}"


def test_a_pit_is_named_with_its_place_and_size_by_machines_fitted_to_lines_that_are_no_teeths(tmp_path: Path) -> None:
    made.make(CASE, tmp_path, tmp_path / "truth")
    folder = tmp_path / CASE.name
    machine = MachineSpec.model_validate(json.loads((folder / "machine.json").read_text(encoding="utf-8")))
    tests, baselines = (
        [read_recording(path, Given()) for path in sorted(folder.glob(f"{kind}_*.npz"))]
        for kind in ("test", "baseline")
    )
    keeper = prebuilt.kept(wanted(), tmp_path / "atlas")
    report = reconcile_recordings(machine, tests, baselines, keeper=keeper, nominated=NOMINATED)
    truth = json.loads((tmp_path / "truth" / f"{CASE.name}.json").read_text(encoding="utf-8"))
    found = score(truth, json.loads(json.dumps(report.document())))
    said = (report.sentence, asdict(found))
    assert report.verdict == "explained" and found.mechanism and found.place, said
    assert "No line confirms" not in report.sentence
    severity = report.causes[0].severity
    assert severity is not None and HIDDEN.value / 3.0 < severity.value < 3.0 * HIDDEN.value
    stages = {str(stage["name"]): stage for stage in report.stages}
    fit = stages["calibrate"]
    assert fit["machines"] == 24 and fit["misfit_after"] < fit["misfit_allowed"]  # type: ignore[operator]
    shares = [float(one["share"]) for one in fit["decided"]]  # type: ignore[attr-defined]
    assert sum(share > 0.97 for share in shares) <= 4, "lines that repeat badly do not decide all numbers"
    assert "inner_spall@bearing1" in stages["judge"]["fitted_with_the_machine"]  # type: ignore[operator]
