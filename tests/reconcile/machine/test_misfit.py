"""A machine file that cannot be moved to its baseline is told, and unknown physics is not read from it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from reconcile.machine.misfit import FOREIGN, FOREIGN_BARE, with_misfit
from reconcile.report.action import to_do
from reconcile.verdict import PlaceWeight, Report, Where
from sim.presets import preset

GEARBOX, RIG = preset("paper-lightly-damped"), preset("bearing-rig")
FARTHEST = {"line": "4*f_m", "speed_hz": 30.0, "channel": "a1", "off_db": -17.6}
FIT = {"misfit_after": 9.4, "strayed": ["gears.0.mass_kg", "gears.1.mass_kg"], "farthest": [FARTHEST]}
UNKNOWN = Report(
    verdict="unknown_physics",
    sentence="Something is missing.",
    level="machine",
    where=Where(sites=(PlaceWeight(site="bearing4", weight=1.0),), limits=("known",)),
    machine={"name": "revised"},
)


def test_unknown_physics_is_not_told_of_another_machine() -> None:
    report = with_misfit(UNKNOWN, FIT, GEARBOX)
    assert report.verdict == "not_decidable" and report.where.sites == () and report.machine is None
    assert (
        "3.1 times their error" in report.sentence
        and "2 numbers at the edge of their spread (gears.0.mass_kg and others)" in report.sentence
    )
    assert "4*f_m at 30 Hz in a1, 18 dB below the file's machines" in report.sentence
    assert report.undecidable[0].endswith("numbers are wrong")
    assert report.next_experiment is not None and "Check the machine file" in report.next_experiment.sentence
    assert report.where.limits[0] == "known" and "does not fit the baseline" in report.where.limits[1]


@pytest.mark.parametrize("verdict", ["nothing_missing", "explained", "ambiguous", "not_decidable"])
def test_other_answers_stand_and_say_it(verdict: str) -> None:
    seen = (cast(Any, SimpleNamespace(term="unbalance")),)
    before = replace(UNKNOWN, verdict=verdict, faintest=seen)  # type: ignore[arg-type]
    report = with_misfit(before, FIT, GEARBOX)
    assert report.faintest == (), "measured with machines that are not this one"
    assert report.verdict == verdict and report.where.sites == before.where.sites
    assert report.sentence.startswith("Something is missing. But the machine file does not fit the baseline")


def test_a_fault_of_the_measurement_has_it_among_its_limits_alone() -> None:
    report = with_misfit(replace(UNKNOWN, verdict="measurement_fault"), FIT, GEARBOX)
    assert report.sentence == UNKNOWN.sentence and len(report.where.limits) == 2


BARE = {**FIT, "misfit_allowed": FOREIGN_BARE}


def test_without_teeth_what_does_not_repeat_is_among_the_errors_and_less_is_foreign() -> None:
    found = with_misfit(UNKNOWN, {**BARE, "misfit_after": FOREIGN_BARE + 0.1}, RIG)
    assert found.verdict == "not_decidable" and "1.4 times their error" in found.sentence


@pytest.mark.parametrize(
    "fit", [{}, {**FIT, "misfit_after": FOREIGN - 0.1}, {**BARE, "misfit_after": FOREIGN_BARE - 0.1}]
)
def test_machines_that_agree_change_nothing(fit: dict[str, object]) -> None:
    assert with_misfit(UNKNOWN, fit, GEARBOX) is UNKNOWN


def test_advice_speaks_of_what_the_machine_has() -> None:
    for machine, teeth in ((GEARBOX, True), (RIG, False)):
        advice = with_misfit(UNKNOWN, FIT, machine).next_experiment
        assert advice is not None and ("teeth" in advice.sentence) == teeth


def test_a_rotor_that_the_file_balances_perfectly_is_told_to_have_an_unbalance() -> None:
    turn = {**FARTHEST, "line": "1*f_r1", "off_db": 118.0}
    fit = {"misfit_after": 9.0, "misfit_allowed": FOREIGN_BARE, "farthest": [turn], "strayed": ["bodies.0.mass_kg"]}
    perfect = RIG.model_copy(update={"terms": [t for t in RIG.terms if t.term != "unbalance"]})
    for before in (UNKNOWN, replace(UNKNOWN, verdict="nothing_missing")):
        report = with_misfit(before, fit, perfect)
        assert "1*f_r1 at 30 Hz in a1, of which the file makes hardly any" in report.sentence
        assert "1 number at the edge of their spread (bodies.0.mass_kg)" in report.sentence
        assert "residual unbalance" in report.sentence + to_do(report)
    assert to_do(report).startswith("correct the machine file first")
    for machine, line in ((RIG, turn), (perfect, {**turn, "line": "2*f_r1"}), (perfect, {**turn, "off_db": 20.0})):
        assert "residual" not in with_misfit(UNKNOWN, {**fit, "farthest": [line]}, machine).next_experiment.sentence  # type: ignore[union-attr]
