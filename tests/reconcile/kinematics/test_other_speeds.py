"""Where nothing says how fast it turned, a name stands only if no other speed makes the impacts another part's."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import Family, Kind, ties
from reconcile.kinematics.observe import observe
from reconcile.kinematics.other_speeds import SPAN, at_speed, by_baseline, nominees
from reconcile.kinematics.unread import ALIKE_Z, Judged, at_either, speed_unread
from reconcile.verdict import Cause, Report
from tests.strategies.half import SPEED_HZ, N, recorded, train

SHAFTS = [{"name": "shaft"}]
BEARINGS = [
    {"name": "drive_end", "shaft": "shaft", "catalogue": "6205"},
    {"name": "fan_end", "shaft": "shaft", "catalogue": "6203"},
]
SPEC = read_kinematic_spec({"kinematics": {"shafts": SHAFTS, "bearings": BEARINGS}})
OUTER, APART = 3.5848, 3.5848 / 3.0534
"""Order of the outer race of a 6205, and over that of a 6203."""


def heard(factor: float, *, hit: bool = True):  # type: ignore[no-untyped-def]
    """Noise and impacts of the 6205's outer race; no line of the shaft; the speed is stated wrong by `factor`."""
    rng = np.random.default_rng(7 if hit else 8)
    row = 0.3 * rng.standard_normal(N)
    return recorded(row + (train(rng, OUTER, 1.0) if hit else 0.0), factor * SPEED_HZ)


def turning(speed_hz: float, method: str) -> SimpleNamespace:
    return SimpleNamespace(speed=SimpleNamespace(shaft="shaft", speed_hz=speed_hz, method=method))


def judged(kind: Kind, site: str, z: float, verdict: str = "explained", order: float = OUTER) -> Judged:
    family = Family(kind=kind, site=site, order=OUTER, spacing=0.0, sidebands=0, slip=0.025)
    best = SimpleNamespace(order=order)
    one = SimpleNamespace(family=family, z=z, best=best, present=True, risen=True, based=True, deep=True)
    cause = Cause(term=f"{kind}_spall", site=site, score=z, named=True)
    report = Report(verdict=verdict, sentence=f"{kind} of {site}.", level="kinematics", causes=(cause,))  # type: ignore[arg-type]
    return Judged(report=report, every=(one,))  # type: ignore[arg-type]


def in_both(z: float, order: float = OUTER) -> Judged:
    """Impacts of no part have risen; those of a race are there as in the baseline."""
    one = judged("outer", "drive_end", z, order=order).every[0]
    one.risen = False  # type: ignore[misc]
    return Judged(report=NOTHING.report, every=(one,))


NOTHING = Judged(report=Report(verdict="unknown_physics", sentence="Foreign.", level="kinematics"), every=())


@pytest.mark.slow
def test_the_outer_race_of_one_bearing_is_not_named_as_that_of_another() -> None:
    report = reconcile_kinematics(SPEC, [heard(APART)], [], seed=3)
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert {(c.term, c.site) for c in report.causes} >= {("outer_spall", "drive_end"), ("outer_spall", "fan_end")}
    assert "The speed is not confirmed by any line" in report.sentence
    assert f"{SPEED_HZ * APART:.4g} Hz as stated" in report.undecidable[0]
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence


@pytest.mark.slow
def test_a_part_that_only_another_speed_explains_is_said_with_that_speed() -> None:
    """At 1.06 times the speed the impacts are no part's."""
    report = reconcile_kinematics(SPEC, [heard(1.06)], [heard(1.06, hit=False)], seed=3)
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert {c.term for c in report.causes if c.site == "drive_end"} == {"outer_spall"}
    assert "as stated the impacts are those of no part" in report.sentence
    assert "of the outer race of drive_end" in report.sentence


@pytest.mark.slow
def test_each_other_part_is_nominated_at_its_own_speed() -> None:
    tie = ties(SPEC)
    seen = observe(heard(1.0), tie, "test 1", stated_hz=None, seed=0)
    assert seen.speed.method == "stated"
    found = {n.family.key: n.factor for n in nominees([seen], tie, 0.0, 0)}
    assert found["fan_end.outer"] == pytest.approx(APART, rel=0.03)
    assert "drive_end.outer" not in found
    assert all(1 / (1 + SPAN) <= f <= 1 / (1 - SPAN) for f in found.values())
    assert nominees([seen], tie, 1e3, 0) == ()


def test_orders_at_another_speed_move_together() -> None:
    tie = ties(SPEC)
    moved = at_speed(tie, 1.1)
    assert moved.shafts == {"shaft": 1.1}
    for one, other in zip(tie.families, moved.families, strict=True):
        assert (other.order, other.spacing) == pytest.approx((1.1 * one.order, 1.1 * one.spacing))


def test_a_baseline_that_was_read_at_the_stated_speed_confirms_it() -> None:
    tests = [turning(30.0, "stated")]
    assert by_baseline(tests, [turning(29.93, "harmonics")])  # type: ignore[list-item, arg-type]
    assert by_baseline(tests, [turning(20.0, "harmonics"), turning(30.1, "tacho")])  # type: ignore[list-item, arg-type]
    assert not by_baseline(tests, [turning(30.0, "stated")])  # type: ignore[list-item, arg-type]
    assert not by_baseline(tests, [turning(28.5, "harmonics")])  # type: ignore[list-item, arg-type]
    assert not by_baseline(tests, [])  # type: ignore[arg-type]


def told(stated: Judged, *others: tuple[Judged, float]) -> Report:
    return speed_unread(stated, others, turning(30.0, "stated"))  # type: ignore[arg-type]


def test_a_name_stands_where_it_is_firmer_than_all_others_by_their_scatter() -> None:
    own = judged("outer", "drive_end", 20.0)
    report = told(own, (judged("outer", "fan_end", 20.0 - ALIKE_Z - 0.1), 35.0))
    assert (report.verdict, report.sentence, report.causes) == ("explained", own.report.sentence, own.report.causes)
    assert "30 Hz as stated: no line confirms it" in report.undecidable[-1]
    assert told(own, (judged("outer", "drive_end", 25.0), 30.9)).verdict == "explained"  # the same part


def with_turn(judgement: Judged, z: float, order: float, chance: float = 0.001, site: str = "shaft") -> Judged:
    family = Family(kind="turn", site=site, order=1.0, spacing=1.0, sidebands=0, slip=0.0)
    best = SimpleNamespace(order=order, channel="de")
    turn = SimpleNamespace(
        family=family, z=z, best=best, chance=chance, present=True, risen=True, based=True, deep=True
    )
    return Judged(report=judgement.report, every=(*judgement.every, turn))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("z", "order", "chance", "site", "confirms"),
    [
        (33.0, 0.998, 0.001, "shaft", True),
        (9.0, 0.998, 0.001, "shaft", False),  # hardly there
        (33.0, 1.012, 0.001, "shaft", False),  # where the search ends: the label is off
        (33.0, 0.998, 0.2, "shaft", False),  # as other orders
        (33.0, 0.998, 0.001, "output", False),  # another shaft's
    ],
)
def test_what_comes_once_a_turn_confirms_the_speed_beside_a_part(
    z: float, order: float, chance: float, site: str, confirms: bool
) -> None:
    own = judged("outer", "drive_end", 20.0)
    report = told(with_turn(own, z, order, chance, site))
    assert (report.verdict, report.sentence, report.causes) == ("explained", own.report.sentence, own.report.causes)
    assert ("once a turn in the envelope of de does, at 29.94 Hz" in " ".join(report.where.limits)) is confirms
    assert any("no line confirms it" in text for text in report.undecidable) is not confirms
    # its multiples are half of those at half the speed: without a part nothing tells
    assert "no line confirms it" in told(with_turn(NOTHING, z, order, chance, site)).undecidable[-1]
    near = judged("outer", "fan_end", 19.0), 35.0
    assert told(with_turn(own, z, order, chance, site), near).verdict == "ambiguous", "another speed as firm"


def test_parts_as_firm_at_other_speeds_are_a_set() -> None:
    near, far = (judged("outer", "fan_end", 19.0), 35.0), (judged("ball", "fan_end", 18.7), 27.0)
    report = told(judged("outer", "drive_end", 20.0), near, far, (judged("inner", "fan_end", 9.0), 26.0))
    assert report.verdict == "ambiguous"
    assert [(c.term, c.site, c.named) for c in report.causes] == [
        ("outer_spall", "drive_end", False),
        ("outer_spall", "fan_end", False),
        ("ball_spall", "fan_end", False),
    ]
    assert [(w.site, round(w.weight, 3)) for w in report.where.sites] == [("drive_end", 0.513), ("fan_end", 0.487)]
    assert "only if it turns at 35 Hz" in report.causes[1].reasons
    assert "at 35 Hz of the outer race of fan_end and at 27 Hz of a ball of fan_end; a tacho" in report.sentence
    assert report.sentence.endswith("At 30 Hz: outer of drive_end.")
    assert "(20 deviations), at 35 Hz of the outer race of fan_end (19 deviations)" in report.undecidable[0]


def test_what_only_another_speed_explains_is_said() -> None:
    report = told(NOTHING, (judged("inner", "drive_end", 15.0), 28.0))
    assert report.verdict == "ambiguous" and report.sentence.endswith("At 28 Hz: inner of drive_end.")
    assert [(c.term, c.named) for c in report.causes] == [("inner_spall", False)]
    quiet = told(NOTHING)
    assert quiet.verdict == "unknown_physics" and "no line confirms it" in quiet.undecidable[-1]
    assert at_either((NOTHING, 30.0)) == ()


def test_a_race_that_the_baseline_has_too_needs_no_other_speed() -> None:
    """The same impacts are another part's at 35 Hz, and weaker ones at 27 Hz; firmer ones of another rate are told."""
    same = judged("inner", "fan_end", 25.0, order=OUTER * 30.0 / 35.0), 35.0
    weaker = judged("ball", "fan_end", 15.0, order=4.4), 27.0
    report = told(in_both(20.0), same, weaker)
    assert report.verdict == "unknown_physics" and "no line confirms it" in report.undecidable[-1]
    assert told(in_both(20.0), (judged("ball", "fan_end", 25.0, order=4.4), 27.0)).verdict == "ambiguous"
    assert told(in_both(10.0, order=2.0), weaker).verdict == "ambiguous"
