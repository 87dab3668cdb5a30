"""Multiples of a shaft that grow together are looseness or a rub, weak as each may be; a few that wander are not."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.series import LEAST_TURNS, ShaftSeries, shaft_series, with_short
from reconcile.verdict import NextExperiment, PlaceWeight, Report, Where
from tests.strategies.brief import RATE_HZ, SPEED_HZ, N, recorded, sound

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [{"name": "pinion", "shaft": "shaft", "teeth": 8}, {"name": "gear", "shaft": "out", "teeth": 21}],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
        }
    }
)
MOTOR = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}]}})
OPEN = Report(
    verdict="ambiguous",
    sentence="Something is loose.",
    level="kinematics",
    where=Where(sites=(PlaceWeight(site="shaft", weight=1.0),)),
    next_experiment=NextExperiment(sentence="Check bolts."),
)
HALVES, WHOLE = (0.5, 1.5, 2.5, 3.5, 4.5), (4.0, 5.0, 6.0, 7.0, 8.0)


def lines(multiples: tuple[float, ...], size: float = 0.1):  # type: ignore[no-untyped-def]
    angle = 2 * np.pi * SPEED_HZ * np.arange(N) / RATE_HZ
    return sum(size * np.cos(m * angle + m) for m in multiples)


def seen(rows, spec=MOTOR, label: str = "test 1") -> Observation:  # type: ignore[no-untyped-def]
    return observe(recorded(rows), ties(spec, "shaft"), label, stated_hz=None, seed=0)


def every(added, spec=MOTOR) -> tuple[ShaftSeries, ...]:  # type: ignore[no-untyped-def]
    return shaft_series([seen(sound(2) + added, spec)], [seen(sound(1), spec, "baseline 1")], ties(spec, "shaft"))


def series(added, spec=MOTOR) -> ShaftSeries | None:  # type: ignore[no-untyped-def]
    return next(iter(every(added, spec)), None)


@pytest.mark.slow
@pytest.mark.parametrize(("multiples", "halves"), [(HALVES, True), (WHOLE, False)])
def test_multiples_that_grew_are_found(multiples: tuple[float, ...], halves: bool) -> None:
    found = series(lines(multiples))
    assert found is not None and found.shaft == "shaft"
    assert set(found.multiples) == set(multiples) and found.halves is halves
    assert found.middle_db > 10.0


@pytest.mark.slow
def test_fewer_than_four_and_none_are_no_series() -> None:
    assert series(lines(WHOLE[:3])) is None
    assert series(0.0 * lines(WHOLE)) is None


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [0.5, 0.7, 2.5])
def test_of_few_turns_no_multiples_are_told_but_how_many_it_takes(seconds: float) -> None:
    """A cut that holds 12 or 17 turns, against a whole baseline or one as short."""
    cut = round(seconds * RATE_HZ)
    added = (sound(2) + lines(HALVES + WHOLE))[:cut]
    tie = ties(MOTOR, "shaft")
    for rows in (sound(1), sound(1)[:cut]):
        test, base = [seen(added)], [seen(rows, label="baseline 1")]
        enough = seconds * SPEED_HZ >= LEAST_TURNS
        assert bool(shaft_series(test, base, tie)) is enough
        report = with_short(OPEN, test, base, tie)
        limits = " ".join(report.where.limits)
        assert ("multiples and halves of a speed are not compared: test 1 holds" in limits) is not enough
        assert report.next_experiment is not None
        first = report.next_experiment.sentence.startswith(
            "Record test and baseline for 0.9 s or longer first (20 turns"
        )
        assert first is not enough and report.next_experiment.sentence.endswith("Check bolts.")


@pytest.mark.slow
def test_lines_about_the_teeth_are_theirs() -> None:
    """Of eight teeth the multiples three to thirteen are sidebands."""
    assert series(lines(WHOLE)) is not None
    assert series(lines(WHOLE), SPEC) is None


@pytest.mark.slow
def test_without_a_baseline_nothing_has_grown() -> None:
    assert not shaft_series([seen(sound(2) + lines(HALVES))], [], ties(MOTOR, "shaft"))


@pytest.mark.slow
def test_whole_multiples_of_a_slow_shaft_are_no_halves_of_a_fast_one() -> None:
    pair = read_kinematic_spec(
        {
            "kinematics": {
                "shafts": [{"name": "shaft"}, {"name": "out"}],
                "gears": [
                    {"name": "pinion", "shaft": "shaft", "teeth": 20},
                    {"name": "gear", "shaft": "out", "teeth": 40},
                ],
                "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
            }
        }
    )
    found = every(lines(tuple(k / 2 for k in range(1, 13))), pair)
    assert found[0].shaft == "out" and not any(one.halves for one in found)


@pytest.mark.slow
def test_a_load_that_moves_every_line_a_little_is_no_series() -> None:
    """Twelve equal lines that grow by 6 dB, each by 6 more or less."""
    scatter = np.array([12.0, 2.0, 11.0, 3.0, 12.5, 1.0, 11.0, 4.0, 12.0, 2.0, 11.5, -3.0])
    grown = [(m, 10 ** (db / 20)) for m, db in enumerate(scatter, 1)]
    before = lines(tuple(float(m) for m, _ in grown))
    after = sum(lines((float(m),), 0.1 * size) for m, size in grown)
    test, base = seen(sound(2) + after), seen(sound(1) + before, label="baseline 1")
    assert np.sum(scatter > 10.0) >= 4, "as many as a series takes"
    assert not shaft_series([test], [base], ties(MOTOR, "shaft"))


@pytest.mark.slow
def test_a_line_that_stands_out_keeps_its_names() -> None:
    loose = sound(2) + lines((1.0,), 30.0) + lines(WHOLE, 3.0)
    report = reconcile_kinematics(MOTOR, [recorded(loose)], [recorded(sound(1))], seed=3)
    assert {"unbalance", "pedestal_looseness"} <= {c.term for c in report.causes}, report.sentence
    assert "mounted otherwise" in report.sentence


@pytest.mark.slow
def test_looseness_far_below_the_first_line_is_told() -> None:
    first = lines((1.0,), 3.0)
    loose = recorded(sound(2) + first + lines(HALVES, 0.2))
    report = reconcile_kinematics(MOTOR, [loose], [recorded(sound(1) + first)], seed=3)
    assert report.verdict == "ambiguous"
    assert "halves of them grew" in report.sentence
    assert [c.term for c in report.causes] == ["pedestal_looseness", "rub"]
    assert {c.site for c in report.causes} == {"shaft"} and {c.score_unit for c in report.causes} == {"dB"}
    assert report.where.lines[0].frequency_hz == pytest.approx(0.5 * SPEED_HZ, rel=0.01)
