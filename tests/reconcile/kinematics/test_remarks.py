"""What stands beside an answer: other lines that rose, an unconfirmed speed, a baseline that was worse."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from reconcile.kinematics import remarks
from reconcile.kinematics.families import Family, Kind
from reconcile.kinematics.remarks import remarked
from reconcile.kinematics.vague import BEFORE_TOO, IN_BOTH
from reconcile.report.action import BESIDE_BEARING, STRIKES, to_do
from reconcile.verdict import Cause, Report


def family(kind: Kind, order: float) -> Family:
    return Family(kind=kind, site="drive_end", order=order, spacing=1.0, sidebands=0, slip=0.02)


def seen(hz: float, method: str = "harmonics") -> SimpleNamespace:
    return SimpleNamespace(speed=SimpleNamespace(speed_hz=hz, method=method))


def candidate(kind: Kind, order: float, z: float, *, risen: bool = True, **how: bool) -> SimpleNamespace:
    rest = {"present": True, "based": True, "deep": True, "by_itself": True, "of_turn": False} | how
    return SimpleNamespace(family=family(kind, order), z=z, risen=risen, growth_db=19.0, **rest)


def replaced(one: SimpleNamespace, site: str) -> SimpleNamespace:
    return SimpleNamespace(**{**vars(one), "family": replace(one.family, site=site)})


@pytest.fixture(autouse=True)
def sound(monkeypatch: pytest.MonkeyPatch) -> None:
    """A baseline of a sound machine."""
    monkeypatch.setattr(remarks, "named", lambda *_: ((), ()))
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: ())


OUTER, INNER = candidate("outer", 3.585, 12.6), candidate("inner", 5.415, 14.5)
SILENT = candidate("inner", 5.415, 2.0, risen=False)
NAMED = Report(
    verdict="explained",
    sentence="A defect.",
    level="kinematics",
    causes=(Cause(term="outer_spall", site="drive_end", score=9.0, named=True),),
)
NOTHING = replace(NAMED, verdict="nothing_missing", sentence="Nothing.", causes=())


def told(report: Report, **how: object) -> Report:
    given = {"tests": [seen(30.0)], "baselines": [], "every": [OUTER, INNER]} | how
    return remarked(report, None, given["tests"], given["baselines"], given["every"], 0)  # type: ignore[arg-type]


def test_lines_as_firm_as_the_named_ones_are_told() -> None:
    (text,) = told(NAMED).undecidable
    assert "drive_end.inner" in text and "19 dB" in text
    quiet = [OUTER, candidate("inner", 5.415, 14.5, risen=False), candidate("ball", 4.7, 5.5)]
    assert told(NAMED, every=quiet).undecidable == ()
    assert told(NAMED, every=[OUTER, candidate("inner", 5.415, 14.5, of_turn=True)]).undecidable == ()


def test_a_turn_and_a_cage_that_rose_beside_a_name_are_commented_on() -> None:
    turn, cage = replaced(candidate("turn", 1.0, 18.4), "shaft"), candidate("cage", 0.398, 9.1)
    (text,) = told(NAMED, every=[OUTER, SILENT, turn, cage]).undecidable
    assert text == (
        "whether the turn of shaft (by 19 dB, 18.4 deviations) and the cage of drive_end (by 19 dB, 9.1 "
        "deviations), which rose too, are more than what modulates a damaged bearing, as its shaft and cage do"
    )
    (one,) = told(NAMED, every=[OUTER, cage, replaced(cage, "fan_end")]).undecidable
    assert "which rose too, is more" in one and "fan_end" not in one, "equal cages have one line"


def test_a_turn_and_a_cage_of_other_parts_are_no_modulation_of_the_named_bearing() -> None:
    """Of a shaft that turns a fourth as fast, and of a bearing with another cage."""
    slow, cage = replaced(candidate("turn", 0.25, 18.4), "output"), replaced(candidate("cage", 0.37, 25.0), "other")
    own, strange = told(NAMED, every=[OUTER, SILENT, candidate("cage", 0.398, 9.1), slow, cage]).undecidable
    assert "the cage of drive_end" in own and "is more than what modulates a damaged bearing" in own
    assert strange.startswith("whether the turn of output (") and "the cage of other (" in strange
    assert strange.endswith("are of another defect: no part of the named bearing turns so")


def test_what_is_not_there_has_not_risen_or_is_told_already_gets_no_comment() -> None:
    quiet = [candidate("turn", 1.0, 18.4, present=False), candidate("cage", 0.398, 9.1, risen=False)]
    assert told(NAMED, every=[OUTER, *quiet]).undecidable == ()
    rose = [OUTER, candidate("turn", 1.0, 18.4)]
    assert told(NOTHING, every=rose).undecidable == ()
    said = (f"{STRIKES} drive_end{BESIDE_BEARING}: a rub, a loose part or a load that turns",)
    assert told(replace(NAMED, undecidable=said), every=rose).undecidable == said


def test_a_speed_that_nothing_confirms_is_a_limit_of_finding_nothing() -> None:
    assert any("no line confirms" in x for x in told(NOTHING, tests=[seen(29.95, "stated")]).where.limits)
    assert told(NOTHING).where.limits == ()
    assert told(NAMED, tests=[seen(29.95, "stated")]).where.limits == ()


def test_baselines_at_another_speed_are_told() -> None:
    report = told(NAMED, tests=[seen(20.0)], baselines=[seen(10.0)])
    assert any("20 Hz" in x and "10 Hz" in x for x in report.where.limits)
    assert told(NAMED, tests=[seen(20.0)], baselines=[seen(20.1)]).where.limits == ()


def test_a_baseline_with_a_defect_that_the_tests_have_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remarks, "named", lambda *_: ((OUTER,), ()))
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: ())
    report = told(NOTHING, baselines=[seen(30.0)])
    assert "drive_end.outer that the tests have not, or 19 dB less" in report.sentence
    assert "exchanged" in report.where.limits[-1]
    assert report.verdict == "not_decidable" and report.next_experiment is not None
    assert "which recording is of the sound machine" in report.next_experiment.sentence
    assert to_do(report).startswith("check which recording is which")
    assert told(NOTHING).sentence == "Nothing." and told(NOTHING).verdict == "nothing_missing"


def test_a_name_stands_beside_what_the_baseline_has_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its lines may be hidden in the tests, so that they are hardly deeper before."""
    monkeypatch.setattr(remarks, "named", lambda *_: ((), (INNER,)))
    report = told(NAMED, baselines=[seen(30.0)], every=[OUTER])
    assert report.verdict == "explained" and "deep lines of drive_end.inner that the tests have not" in report.sentence
    assert "check which recording is which" in to_do(report)
    for quiet in ({"by_itself": False}, {"present": False}):
        monkeypatch.setattr(remarks, "named", lambda *_, how=quiet: ((), (candidate("inner", 5.415, 9.0, **how),)))
        assert told(NAMED, baselines=[seen(30.0)], every=[OUTER]).sentence == NAMED.sentence


def test_the_named_part_is_not_told_of_the_baseline_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remarks, "named", lambda *_: ((), (OUTER,)))
    assert told(NAMED, baselines=[seen(30.0)], every=[OUTER]).sentence == NAMED.sentence
    assert told(NAMED, baselines=[seen(30.0)], every=[INNER]).sentence == NAMED.sentence


def test_a_race_that_is_deep_in_both_is_told_beside_what_changed() -> None:
    changed = replace(NAMED, verdict="ambiguous", sentence="Impacts once a turn.", causes=())
    old = candidate("inner", 5.415, 20.2, risen=False)
    assert "drive_end.inner is deep in both" in told(changed, every=[old]).sentence
    for how in ({"deep": False}, {"present": False}, {"based": False}):
        assert told(changed, every=[candidate("inner", 5.415, 20.2, risen=False, **how)]).sentence == changed.sentence
    assert told(NAMED, every=[old]).sentence == NAMED.sentence


def test_a_baseline_with_a_tooth_that_the_tests_have_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remarks, "named", lambda *_: ((), ()))
    rows = [SimpleNamespace(gear="wheel", mesh="mesh1", grown=True), SimpleNamespace(gear="p", mesh="m", grown=False)]
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: rows)
    report = told(NOTHING, baselines=[seen(30.0)])
    assert "deep lines of wheel's turn around mesh1 that the tests have not" in report.sentence
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: rows[1:])
    assert told(NOTHING, baselines=[seen(30.0)]).sentence == "Nothing."


@pytest.mark.parametrize(("deeper", "kept"), [("drive_end.outer", False), ("fan_end.outer", True)])
def test_what_the_baseline_alone_has_is_not_told_to_be_in_both(
    deeper: str, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = f"the baseline has deep lines of {deeper} that the tests have not"
    monkeypatch.setattr(remarks, "_deeper_before", lambda *_: [text])
    both = f" But drive_end.outer is {IN_BOTH}: {BEFORE_TOO}."
    report = told(replace(NOTHING, verdict="not_decidable", sentence=f"Quieter.{both}"))
    assert report.sentence == f"Quieter.{both if kept else ''} But {text}."
