"""Cases that are run again: at once where their atlas is there, and compared with what was stored."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

from proof.__main__ import parted
from proof.entire import entire
from proof.plan import plan
from proof.score.one import Score
from proof.score.stored import compared

SCORE = Score(
    name="e001",
    group="single",
    laws=("bow",),
    level=1,
    sensors=3,
    snr_db=20.0,
    speeds=3,
    baseline=True,
    verdict="explained",
    failed=False,
    verdict_right=True,
    alarm=True,
    mechanism=True,
    place=False,
    severity_error=0.1,
    core_seconds=90.0,
)


def test_each_atlas_is_made_once_before_cases_run_at_once():
    cases = entire()
    first, rest = parted(cases)
    assert sorted(c.name for c in (*first, *rest)) == [c.name for c in cases]

    def needs(case):
        return case.torque_nm, case.speeds_hz, case.name if case.group == "misset" else ""

    assert len({needs(c) for c in first}) == len(first) and {needs(c) for c in rest} <= {needs(c) for c in first}
    assert len(parted(plan("quiet"))[0]) == 1


def test_a_case_that_answers_otherwise_is_told(tmp_path):
    path = tmp_path / "entire.json"
    path.write_text(json.dumps({"engine": "a", "scores": [asdict(SCORE), asdict(replace(SCORE, name="e002"))]}))
    near = replace(SCORE, severity_error=0.1001, core_seconds=200.0)
    assert compared(path, "a", [near, replace(SCORE, name="e009")]) == [
        "1 of 1 as stored in entire.json (the same engine)"
    ]
    other = replace(SCORE, name="e002", place=True, severity_error=None)
    head, line = compared(path, "b", [near, other])
    assert head == "1 of 2 as stored in entire.json (engine a, here b)"
    assert line == "e002 is not: place False was stored, now True, severity_error 0.1 was stored, now None"
