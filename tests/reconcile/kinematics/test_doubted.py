"""Where half or twice the stated speed explains the shaft's lines, nothing is named that hangs on it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.doubted import against_rivals, doubt_of, factor_of
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import observe
from reconcile.verdict import Report
from signals.recording import Recording, Tacho
from tests.strategies.impulses import SECONDS, SPEED_HZ, N, recorded, shaft_lines, sound, train

SHAFTS = [{"name": "shaft"}]
BEARING = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
SPEC = read_kinematic_spec({"kinematics": {"shafts": SHAFTS, "bearings": [BEARING]}})
ORDERS = {"outer_spall": 3.5848, "inner_spall": 5.4152}


def made(term: str | None, factor: float, seed: int = 2) -> Recording:
    """The speed is stated wrong by `factor`."""
    hit = 0.0 if term is None else train(np.random.default_rng(seed), 0.992 * ORDERS[term], 1.0, load=0.3)
    return recorded(sound(seed) + hit, SPEED_HZ * factor)


@pytest.mark.slow
@pytest.mark.parametrize("term", sorted(ORDERS))
@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_defect_at_a_speed_wrong_by_two_is_not_named(term: str, factor: float) -> None:
    report = reconcile_kinematics(SPEC, [made(term, factor)], [made(None, factor, 1)], seed=3)
    assert report.verdict == "ambiguous"
    assert report.sentence.startswith("The speed is not decided")
    assert f"{SPEED_HZ} Hz" in report.sentence
    assert report.causes[0].term == term
    assert not any(c.named for c in report.causes)
    assert "whether shaft turns" in report.undecidable[0]
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence
    rate = {0.5: "half", 2.0: "twice"}[factor]  # a file read as twice as fast turns twice as fast
    assert f"or the sampling rate is {rate} the one stated" in report.sentence and rate in report.undecidable[0]
    assert "Look up the sampling rate first" in report.next_experiment.sentence
    speed = next(s for s in report.stages if s["name"] == "speed")
    assert speed["found"]["test 1"]["rival_hz"] == pytest.approx(SPEED_HZ, rel=1e-3)  # type: ignore[index]


@pytest.mark.slow
def test_a_right_speed_is_not_doubted() -> None:
    report = reconcile_kinematics(SPEC, [made("outer_spall", 1.0)], [made(None, 1.0, 1)], seed=3)
    assert report.verdict == "explained"
    assert not any("whether shaft turns" in text for text in report.undecidable)


@pytest.mark.slow
def test_the_bearing_decides_where_the_shaft_does_not() -> None:
    """Only even harmonics, as misalignment makes them, and the right speed: BPFO is met at its odd multiples too."""
    rng = np.random.default_rng(5)
    rows = [shaft_lines(rng, 2 * SPEED_HZ) + 0.3 * rng.standard_normal(N) for _ in range(2)]
    hit = train(np.random.default_rng(2), 0.992 * ORDERS["outer_spall"], 1.0)
    report = reconcile_kinematics(SPEC, [recorded(rows[0] + hit)], [recorded(rows[1])], seed=3)
    assert (report.verdict, report.causes[0].term) == ("explained", "outer_spall")


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.5, 1.0])
def test_without_lines_of_the_shaft_the_bearing_tells_a_wrong_speed(factor: float) -> None:
    """Noise and impacts only: nothing confirms the stated speed."""
    rng = np.random.default_rng(7)
    hit = train(np.random.default_rng(2), 0.992 * ORDERS["outer_spall"], 1.0)
    rows = [0.3 * rng.standard_normal(N) for _ in range(2)]
    stated = factor * SPEED_HZ
    report = reconcile_kinematics(SPEC, [recorded(rows[0] + hit, stated)], [recorded(rows[1], stated)], seed=3)
    assert report.causes[0].term == "outer_spall"
    if factor == 1.0:
        assert (report.verdict, report.causes[0].named) == ("explained", True)
    else:
        assert report.verdict == "ambiguous" and not report.causes[0].named
        assert "bearing lines fit 24.3 Hz, twice the stated speed, better than 12.15 Hz" in report.sentence
        assert "no line of it tells" in report.undecidable[0]


@pytest.mark.slow
def test_a_sound_machine_stays_one_and_the_doubt_is_said() -> None:
    report = reconcile_kinematics(SPEC, [made(None, 0.5, 4)], [made(None, 0.5, 1)], seed=3)
    assert report.verdict == "nothing_missing"
    assert "whether shaft turns at 12.15 Hz as stated or at 24.3 Hz" in report.undecidable[0]


@pytest.mark.slow
def test_another_shaft_or_a_tacho_decides() -> None:
    """Lines between the multiples are those of a shaft geared down by two; pulses need no harmonics."""
    halves = recorded(sound(4), 2 * SPEED_HZ)
    alone = ties(SPEC, "shaft")
    gears = [{"name": "a", "shaft": "shaft", "teeth": 20}, {"name": "b", "shaft": "slow", "teeth": 40}]
    meshes = [{"name": "m", "gears": ["a", "b"]}]
    geared = {"shafts": [*SHAFTS, {"name": "slow"}], "bearings": [BEARING], "gears": gears, "meshes": meshes}
    seen = observe(halves, alone, "test 1", stated_hz=None, seed=0)
    assert factor_of(seen, alone) == 0.5
    assert doubt_of([seen], alone) == (seen, 0.5)
    assert factor_of(seen, ties(read_kinematic_spec({"kinematics": geared}), "shaft")) is None
    pulses = np.arange(int(SECONDS * SPEED_HZ)) / SPEED_HZ
    timed = replace(halves, tacho=Tacho(shaft="shaft", pulse_times_s=pulses))
    assert factor_of(observe(timed, alone, "test 1", stated_hz=None, seed=0), alone) is None


@pytest.mark.slow
def test_a_stated_speed_far_from_the_drawing_that_no_line_confirms_names_no_race() -> None:
    """At two thirds of the speed the outer race's lines lie where the inner race's would: each statement fits."""
    rng = np.random.default_rng(7)
    hit = train(np.random.default_rng(2), ORDERS["outer_spall"], 1.0)
    rows = [0.3 * rng.standard_normal(N) for _ in range(2)]
    stated = SPEED_HZ * ORDERS["outer_spall"] / ORDERS["inner_spall"]
    given = [recorded(row, stated) for row in (rows[0] + hit, rows[1])]
    drawn = read_kinematic_spec(
        {"kinematics": {"shafts": [{"name": "shaft", "speed_hz": SPEED_HZ}], "bearings": [BEARING]}}
    )
    report = reconcile_kinematics(drawn, given[:1], given[1:], seed=3)
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert {c.term for c in report.causes} >= {"outer_spall", "inner_spall"}
    assert "the speed of the machine file" in report.sentence
    alone = reconcile_kinematics(SPEC, given[:1], given[1:], seed=3)
    assert alone.causes[0].term == "inner_spall"


@pytest.mark.parametrize(
    ("label_hz", "method", "z", "verdict"),
    [
        (49.9, "stated", 12.0, "ambiguous"),
        (49.9, "stated", 0.0, "nothing_missing"),
        (25.5, "stated", 12.0, "nothing_missing"),
        (49.9, "harmonics", 12.0, "nothing_missing"),
    ],
)
def test_where_nothing_is_found_a_label_far_off_the_drawing_is_held_against_it(
    label_hz: float, method: str, z: float, verdict: str
) -> None:
    speed = SimpleNamespace(shaft="motor", speed_hz=label_hz, method=method, rival_hz=None)
    quiet = Report(verdict="nothing_missing", sentence="No family.", level="kinematics")
    defect = Report(verdict="explained", sentence="A defect.", level="kinematics")
    none = {"firmest": None, "heard_z": 0.0, "part": "no part", "hears": lambda *_: False}
    here = SimpleNamespace(report=quiet, every=(), z=0.0, **none)
    asked: list[float] = []

    def at(factor: float, _firmly: bool) -> SimpleNamespace:
        asked.append(factor)
        return SimpleNamespace(report=defect, every=(), z=z, **none)

    for others in (None, [0.5]):
        found = against_rivals(here, [SimpleNamespace(speed=speed)], ties(SPEC), at, 24.95, others)  # type: ignore[arg-type]
        assert found.verdict == verdict
        if verdict == "ambiguous":
            assert "24.95 Hz" in found.sentence and found.sentence.endswith("A defect.")
    assert method == "stated" or not asked
