"""What stands beside an answer: other lines that rose, an unconfirmed speed, a baseline that was worse."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from reconcile.kinematics import remarks
from reconcile.kinematics.families import Family, Kind
from reconcile.kinematics.remarks import remarked
from reconcile.verdict import Cause, Report


def family(kind: Kind, order: float) -> Family:
    return Family(kind=kind, site="drive_end", order=order, spacing=1.0, sidebands=0, slip=0.02)


def seen(hz: float, method: str = "harmonics") -> SimpleNamespace:
    return SimpleNamespace(speed=SimpleNamespace(speed_hz=hz, method=method))


def candidate(kind: Kind, order: float, z: float, *, risen: bool = True) -> SimpleNamespace:
    return SimpleNamespace(family=family(kind, order), z=z, risen=risen, growth_db=19.0)


OUTER, INNER = candidate("outer", 3.585, 12.6), candidate("inner", 5.415, 14.5)
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
    assert "drive_end.outer" in report.sentence and "exchanged" in report.where.limits[-1]
    assert told(NOTHING).sentence == "Nothing."


def test_a_baseline_with_a_tooth_that_the_tests_have_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remarks, "named", lambda *_: ((), ()))
    rows = [SimpleNamespace(gear="wheel", mesh="mesh1", grown=True), SimpleNamespace(gear="p", mesh="m", grown=False)]
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: rows)
    report = told(NOTHING, baselines=[seen(30.0)])
    assert "deep lines of wheel's turn around mesh1 that the tests have not" in report.sentence
    monkeypatch.setattr(remarks, "gear_evidence", lambda *_: rows[1:])
    assert told(NOTHING, baselines=[seen(30.0)]).sentence == "Nothing."
