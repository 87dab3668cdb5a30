"""Scores of made-up reports whose worth is plain, and the intervals of rates."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, replace

import numpy as np
import pytest

from proof import __main__ as commands
from proof.case import truth_of
from proof.engine_id import engine_id
from proof.page import write_page
from proof.plan import COUNTS, plan
from proof.run import Engine, run_case, slim
from proof.score.one import channel_name, score
from proof.score.rates import Rate, at_target, summary, wilson
from proof.score.stored import OtherRun, together
from proof.score.table import table


def truth(group, law=None):
    cases = (*plan("dev"), *plan("sealed"))
    found = next(c for c in cases if c.group == group and (law is None or any(e.law == law for e in c.effects)))
    return json.loads(json.dumps(truth_of(found)))


def cause(term, site, value=None, *, named=True, name="gap", low=0.0, high=1.0):
    severity = None if value is None else {"name": name, "value": value, "unit": "m", "low": low, "high": high}
    return {"term": term, "site": site, "severity": severity, "named": named, "score": 1.0}


def right(case):
    """The report of an engine that knows everything."""
    if case["group"] in {"null", "misset"}:
        return {"verdict": "nothing_missing"}
    if case["group"] == "sensor":
        channel = channel_name(case["sensors"][case["fault_channel"]])
        return {"verdict": "measurement_fault", "fault": {"kind": case["fault"], "channel": channel}}
    if case["group"] == "open":
        return {"verdict": "unknown_physics", "where": {"sites": [{"site": case["effects"][0]["site"], "weight": 0.9}]}}
    if case["group"] == "ambiguous":
        return {"verdict": "ambiguous", "causes": [cause(t, s, named=False) for t, s in case["causes"]]}
    causes = [cause(e["terms"][0], e["sites"][0], e["value"], name=e["severity"]["name"]) for e in case["effects"]]
    held = {"gain": 0.7, "gain_low": 0.6, "retuned": 0.3, "black_box": 0.5, "placebo": 0.01}
    return {"verdict": "explained", "causes": causes, "held_out": held, "provenance": {"cost": {"core_s": 50.0}}}


@pytest.mark.parametrize("split", ["dev", "sealed", "later", "third"])
def test_an_engine_that_knows_everything_is_right_in_everything(split):
    scores = [score(t, right(t)) for t in (json.loads(json.dumps(truth_of(c))) for c in plan(split))]
    assert all(s.verdict_right for s in scores)
    for name in ("mechanism", "place", "top_three", "both", "unknown_flagged", "cannot_tell", "fault_kind"):
        asked = name != "cannot_tell" or "ambiguous" in COUNTS[split]
        assert {getattr(s, name) for s in scores} == ({True, None} if asked else {None}), name
    assert not any(s.alarm for s in scores if s.group in {"null", "misset"})
    assert not any(s.false_unknown for s in scores)
    errors = [s.severity_error for s in scores if s.severity_error is not None and s.laws[0] != "root_crack"]
    assert errors
    assert max(errors) < 1e-12
    assert "wrong:\n" in table(scores)
    assert table(scores).endswith("wrong:\n")


def test_undetected_and_failed_cases_stay_in_the_denominator():
    case = truth("single", "loose_fit")
    for report in (
        None,
        {"verdict": "nothing_missing"},
        {"verdict": "not_decidable"},
        {"verdict": "measurement_fault"},
    ):
        found = score(case, report)
        assert (found.mechanism, found.place, found.top_three, found.alarm) == (False, False, False, False)
        assert not found.verdict_right
        assert found.failed == (report is None)


def test_either_form_of_the_clearance_is_right_and_another_bearing_is_not():
    case = truth("single", "loose_fit")
    site = case["effects"][0]["site"]
    other = "bearing4" if site != "bearing4" else "bearing1"
    for term, place, told in (
        ("fit_clearance", site, (True, True)),
        ("fit_clearance_series", site, (True, True)),
        ("fit_clearance_series", other, (True, False)),
        ("pedestal_looseness", site, (False, False)),
    ):
        found = score(case, {"verdict": "explained", "causes": [cause(term, place)]})
        assert (found.mechanism, found.place) == told


def test_a_guess_further_down_counts_for_the_first_three_only():
    case = truth("single", "outer_pit")
    site = case["effects"][0]["site"]
    causes = [cause("unbalance", "gear"), cause("outer_spall", site, named=False)]
    found = score(case, {"verdict": "explained", "causes": causes})
    assert (found.mechanism, found.top_three) == (False, True)


def test_severity_is_compared_in_one_measure():
    case = truth("single", "root_crack")
    case["effects"][0]["severity"]["value"] = 0.039
    site = case["effects"][0]["site"]
    told = cause("tooth_crack", site, 0.3, name="depth", low=0.25, high=0.35)
    found = score(case, {"verdict": "explained", "causes": [told]})
    assert found.severity_error == pytest.approx(0.0, abs=1e-12)
    assert found.severity_covered is True


def test_a_closed_effect_called_unknown_is_a_false_unknown():
    found = score(truth("single", "inner_pit"), {"verdict": "unknown_physics"})
    assert found.false_unknown is True
    assert found.alarm is True
    assert found.mechanism is False


def test_a_name_for_an_unknown_effect_is_wrong():
    found = score(truth("open"), {"verdict": "explained", "causes": [cause("unbalance", "gear")]})
    assert (found.verdict_right, found.unknown_flagged, found.alarm) == (False, False, True)


def test_wilson_agrees_with_its_definition():
    low, high = wilson(8, 10, 1.959963984540054)
    assert (low, high) == pytest.approx((0.4901625, 0.9433178), abs=1e-6)
    for edge in (low, high):  # the ends are where the share is z standard errors away
        assert abs(0.8 - edge) == pytest.approx(1.959963984540054 * np.sqrt(edge * (1 - edge) / 10))
    assert wilson(0, 0) == (0.0, 1.0)
    assert Rate(hits=0, n=20).interval[0] == 0.0


@pytest.mark.slow
def test_the_page_is_written_from_a_summary(tmp_path):
    scores = [score(t, right(t)) for t in (json.loads(json.dumps(truth_of(c))) for c in plan("dev"))]
    scores.append(score(truth("single", "loose_fit"), None))
    document = {"split": "dev", **summary(scores), "scores": [vars(s) for s in scores]}
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "dev.json").write_text(json.dumps(document))
    page = write_page(tmp_path / "docs", tmp_path / "results")
    text = page.read_text()
    assert "of split `dev`" in text and "of split `sealed`" not in text
    assert "said failed" in text
    assert (tmp_path / "docs" / "proof" / "dev.svg").exists()
    assert any(map(at_target, scores))


ENGINE = """
import json, pathlib, sys
a = sys.argv
out = pathlib.Path(a[a.index("--out") + 1])
if a[1] == "machine":
    out.write_text("{}")
else:
    out.mkdir()
    seen = {"verdict": "nothing_missing", "pictures": [1], "given": a, "force": {"law": None, "samples": [1]}}
    (out / "report.json").write_text(json.dumps(seen))
"""


def made_case(folder):
    case = folder / "d001"
    case.mkdir()
    for name in ("machine", "baseline_1", "baseline_2", "test_1", "test_2"):
        (case / f"{name}.json").write_text("{}")
    return case


@pytest.mark.slow
def test_the_engine_gets_a_copy_without_the_name_and_is_run_once(tmp_path):
    script = tmp_path / "engine.py"
    script.write_text(ENGINE)
    engine = Engine(command=(sys.executable, str(script)), atlas=tmp_path / "atlas", jobs=1)
    case = made_case(tmp_path)
    result = run_case(engine, case, tmp_path / "results")
    assert result["error"] is None
    given = result["report"]["given"]
    assert not [word for word in given if "d001" in word]
    assert given.count("--baseline") == given.count("--recording") == 1
    assert given[given.index("--atlas") + 1] == str(tmp_path / "atlas")
    assert sum(word.endswith("_1.json") for word in given) == 2
    assert "pictures" not in result["report"]
    assert result["report"]["force"] == {"law": None}
    script.write_text("raise SystemExit(3)")
    assert run_case(engine, case, tmp_path / "results") == result
    failed = run_case(engine, case, tmp_path / "results", fresh=True)
    assert failed["report"] is None
    assert "exit code 3" in failed["error"]


@pytest.mark.slow
def test_an_engine_that_does_not_answer_is_a_failure(tmp_path):
    script = tmp_path / "engine.py"
    script.write_text("import time; time.sleep(60)")
    engine = Engine(command=(sys.executable, str(script)), timeout_s=0.2)
    result = run_case(engine, made_case(tmp_path), tmp_path / "results")
    assert "no answer" in result["error"]


@pytest.mark.slow
def test_what_another_engine_stored_is_run_again(tmp_path):
    script = tmp_path / "engine.py"
    script.write_text(ENGINE)
    engine, case, results = Engine(command=(sys.executable, str(script))), made_case(tmp_path), tmp_path / "results"
    first = run_case(engine, case, results)
    stored = results / f"{case.name}.json"
    stored.write_text(json.dumps({**first, "wall_s": -1.0}))
    assert run_case(engine, case, results)["wall_s"] == -1.0
    stored.write_text(json.dumps({**first, "wall_s": -1.0, "engine": "another"}))
    assert run_case(engine, case, results)["wall_s"] > 0.0


def test_an_engine_is_known_by_the_source_that_it_imports(tmp_path):
    files = {
        "sim/law.py": "a = 1",
        "reconcile/unsteady.py": "",
        "reconcile/machine/engine.py": "from reconcile.machine import judge\nfrom signals.series import Series",
        "reconcile/machine/judge.py": "import numpy, reconcile.report.page",
        "reconcile/report/page.py": "b = 1",
        "reconcile/kinematics/reconcile.py": "from signals import series",
        "reconcile/kinematics/vague.py": "c = 1",
        "signals/series.py": "d = 1",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text + "\n")

    def ids():
        return [engine_id.__wrapped__(level, tmp_path) for level in ("machine", "kinematics")]

    first = ids()
    for name, moved in (
        ("sim/law.py", [True, True]),
        ("signals/series.py", [True, True]),
        ("reconcile/machine/judge.py", [True, False]),
        ("reconcile/report/page.py", [False, False]),
        ("reconcile/kinematics/vague.py", [False, False]),
    ):
        (tmp_path / name).write_text(files[name] + "\nz = 2\n")
        assert [a != b for a, b in zip(first, ids(), strict=True)] == moved, name
        (tmp_path / name).write_text(files[name] + "\n")


def test_slim_keeps_what_is_scored():
    assert slim({"verdict": "explained", "machine": {}, "stages": [], "pictures": {}, "causes": []}) == {
        "verdict": "explained",
        "stages": [],
        "causes": [],
    }


def test_unknown_cases_are_named(monkeypatch, tmp_path):
    given = commands.parser().parse_args(["run", "--split", "dev", "--cases", "d001,zzz", "--data", str(tmp_path)])
    with pytest.raises(SystemExit, match="zzz"):
        commands.chosen(given)
    assert [
        c.name for c in commands.chosen(commands.parser().parse_args(["run", "--split", "dev", "--cases", "2"]))
    ] == [
        "d001",
        "d002",
    ]


def test_what_was_not_detected_beats_no_black_box():
    case = truth("single", "outer_pit")
    assert score(case, {"verdict": "nothing_missing"}).beats_black_box is False
    assert score(truth("null"), {"verdict": "nothing_missing"}).beats_black_box is None


def test_what_the_report_says_it_would_have_seen_is_held_against_it():
    case = truth("single", "outer_pit")
    (effect,) = case["effects"]
    row = {
        "term": effect["terms"][0],
        "site": effect["sites"][0],
        "name": effect["severity"]["name"],
        "seen_from": None,
    }

    def told(**changes):
        found = score(case, {"verdict": "nothing_missing", "faintest": [row | changes]})
        return found.told_unseen, table([found])

    assert told()[0] and told(seen_from=1.1 * effect["value"])[0]
    assert told(seen_from=0.9 * effect["value"])[0] is False
    assert "need not show" in told()[1] and "though by its own table it shows" in told(seen_from=1e-9)[1]
    assert told(site="elsewhere")[0] is None and score(case, {"verdict": "nothing_missing"}).told_unseen is None
    assert score(case, right(case) | {"faintest": [row]}).told_unseen is None


def test_scores_of_parts_of_a_split_are_joined_and_first_runs_stand(tmp_path):
    first = [
        replace(score(truth("null"), {"verdict": v}), name=n) for n, v in (("q1", "nothing_missing"), ("q2", "failed"))
    ]
    path = tmp_path / "quiet.json"
    document = {"split": "quiet", "engine": "abc", "scores": [asdict(s) for s in first]}
    path.write_text(json.dumps(document), encoding="utf-8")
    later = [replace(first[0], name=name, verdict="explained", alarm=True) for name in ("q1", "q3")]
    found = together(path, "quiet", "abc", later)
    assert [(s.name, s.alarm) for s in found] == [("q1", False), ("q2", False), ("q3", True)]
    assert found[0] == first[0]
    with pytest.raises(OtherRun, match="engine abc"):
        together(path, "quiet", "abd", later)
