"""What the page draws: every operating point by its name, every form of an effect beside the one it counts with."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.calibrate.chain import band_centres_hz
from reconcile.judge.screen import Screen
from reconcile.machine.pictures import TURN_BINS, as_named, forms, spectra, turn_maps, with_forms
from reconcile.machine.weigh import merged_weights
from reconcile.machine.words import with_points
from reconcile.observe.features import Layout
from reconcile.observe.steady import Steady
from reconcile.verdict import AngleWindow, Cause, HeldOut, Report
from sim.presets import preset

BANDS = band_centres_hz().size
LAYOUT = Layout(lines=2, bands=BANDS, shapes=1, modulations=1)
POINTS = (Point(speed_hz=22.5), Point(speed_hz=30.0, torque_ratio=0.5))
CHANNELS = ("a", "b")
RATE_HZ = 20000.0


def turned(speed_hz: float, ratio: float, at_deg: float, height: float, start_turns: float = 0.0) -> Steady:
    """Noise that is loudest at one angle of a shaft of so many turns a turn of the drive shaft."""
    turns = start_turns + np.arange(40000) * speed_hz / RATE_HZ
    away = (ratio * turns % 1.0 * 360.0 - at_deg + 180.0) % 360.0 - 180.0
    rough = np.random.default_rng(3).normal(size=(2, turns.size))
    samples = rough * (1.0 + height * np.exp(-((away / 10.0) ** 2)))
    estimate = SimpleNamespace(method="tacho")
    return Steady(samples=samples, rate_hz=RATE_HZ, speed_hz=speed_hz, estimate=estimate, start_turns=start_turns)  # type: ignore[arg-type]


def seen(point: Point, level_db: float) -> SimpleNamespace:
    def power(db: float) -> SimpleNamespace:
        return SimpleNamespace(total=np.full((2, BANDS), 10.0 ** (db / 10.0)))

    lines = np.array([1.0, 2.0]) * point.speed_hz
    sound = turned(point.speed_hz, 1.0, 0.0, 0.0)
    return SimpleNamespace(
        point=point, test=power(level_db), baseline=power(0.0), lines_hz=lines, spectra=(sound, sound)
    )


@pytest.fixture
def data() -> list[SimpleNamespace]:
    return [seen(point, 3.0 * (i + 1)) for i, point in enumerate(POINTS)]


def test_spectra_are_of_every_operating_point_with_the_answer_of_that_point(data: list[SimpleNamespace]) -> None:
    fitted = np.repeat([1.0, 2.0, 3.0, 4.0], LAYOUT.size)
    found = spectra(data, [None, None], fitted, LAYOUT, CHANNELS)  # type: ignore[arg-type, list-item]
    assert [(p["channel"], p["speed_hz"], p["torque_ratio"]) for p in found] == [
        ("a", 22.5, 1.0),
        ("b", 22.5, 1.0),
        ("a", 30.0, 0.5),
        ("b", 30.0, 0.5),
    ]
    assert [p["after_db"][0] for p in found] == [1.0, 2.0, 3.0, 4.0]  # type: ignore[index]
    assert [p["observed_db"][0] for p in found] == [3.0, 3.0, 6.0, 6.0]  # type: ignore[index]


def test_the_turn_is_drawn_on_the_shaft_of_the_place_with_its_angle_and_every_sensor() -> None:
    machine = preset("paper-demo")
    pinion, gear = machine.gears[0], machine.gears[1]
    window = AngleWindow(shaft=gear.shaft, centre_deg=95.0, low_deg=90.0, high_deg=100.0)
    ratio = pinion.teeth / gear.teeth
    now, before = turned(30.0, ratio, 95.0, 6.0, 0.3), turned(30.0, ratio, 95.0, 0.0)
    one = SimpleNamespace(point=POINTS[1], spectra=(now, before))
    (found,) = turn_maps(machine, [one], CHANNELS, window)  # type: ignore[list-item]
    value, angle = np.array(found["value"]), np.array(found["angle_deg"])
    assert value.shape == (2, TURN_BINS) and found["rows"] == ["a", "b"]
    assert np.all(np.abs(angle[value.argmax(axis=1)] - 95.0) < 15.0)
    assert (found["shaft"], found["speed_hz"]) == (gear.shaft, 30.0)
    assert found["value_label"] == "energy, dB over the mean of the baseline"
    (drive,) = turn_maps(machine, [one], CHANNELS, None)  # type: ignore[list-item]
    assert machine.operating is not None and drive["shaft"] == machine.operating.shaft


def test_what_every_tooth_brings_is_even_and_what_one_brings_stands_out() -> None:
    machine = preset("paper-demo")
    pinion = machine.gears[0]
    turns = np.arange(60000) * 30.0 / RATE_HZ
    away = (turns % 1.0 * 360.0 - 23.0 + 180.0) % 360.0 - 180.0
    swell = 1.0 + 0.6 * np.sin(2 * np.pi * pinion.teeth * turns)
    rough = np.random.default_rng(4).normal(size=(2, turns.size))

    def heard(height: float) -> Steady:
        samples = rough * swell * (1.0 + height * np.exp(-((away / 8.0) ** 2)))
        return Steady(samples=samples, rate_hz=RATE_HZ, speed_hz=30.0, estimate=SimpleNamespace(method="tacho"))  # type: ignore[arg-type]

    one = SimpleNamespace(point=POINTS[1], spectra=(heard(0.4), heard(0.0)))
    (found,) = turn_maps(machine, [one], CHANNELS, None)  # type: ignore[list-item]
    value, angle = np.array(found["value"]), np.array(found["angle_deg"])
    assert np.all(np.abs(angle[value.argmax(axis=1)] - 23.0) < 10.0)
    far = np.abs((angle - 23.0 + 180.0) % 360.0 - 180.0) > 40.0
    assert np.ptp(value[:, far]) < 0.5 * (value.max() - np.median(value)), "swells of single teeth are even"


def test_forms_stand_beside_the_effect_they_count_with() -> None:
    evidence = {
        "fit_clearance@bearing1": 44.0,
        "fit_clearance_series@bearing1": 42.0,
        "squeeze_film@bearing1": 34.0,
        "bearing_stiffness@bearing2": 10.0,
    }
    values = np.array(list(evidence.values()))
    weights = np.exp(values - values.max())
    screen = Screen(
        names=tuple(evidence), evidence=values, direct=0 * values, weights=weights / weights.sum(),
        by=np.zeros(values.size, dtype=int), p_any=0.0, strongest=40.0, p_best=0.0, p_direct=1.0, misfit=0.4,
        length=90.0,
    )  # fmt: skip
    heads = forms(screen)
    assert {*evidence} - {*heads} == {*merged_weights(screen)}
    loose = Cause(term="fit_clearance", site="bearing1", score=44.0)
    soft = Cause(term="bearing_stiffness", site="bearing2", score=10.0)
    first, second = with_forms([loose, soft], screen)
    assert first.forms == {"fit_clearance_series": 42.0}
    assert second.forms == {}


def test_what_was_held_out_is_said_by_its_operating_points(data: list[SimpleNamespace]) -> None:
    held = HeldOut(
        metric="m", unit="dB", before=2.0, after=1.0, gain=0.5, gain_low=0.4, gain_high=0.6, retuned=None,
        black_box=None, placebo=None, held="each operating point in turn, fitted on the others",
    )  # fmt: skip
    said = with_points(held, data).held  # type: ignore[arg-type]
    assert said == "each operating point in turn, fitted on the others: 22.5 Hz, 30 Hz at 0.5 of the torque"


def test_a_name_that_was_taken_back_is_marked_in_no_picture() -> None:
    rows = [{"label": f"outer_spall@bearing{k}", "score": 9.0, "named": k == 1} for k in (1, 2)]
    causes = tuple(Cause(term="outer_spall", site=f"bearing{k}", score=9.0, named=k == 2) for k in (1, 2))
    report = Report(verdict="explained", sentence="", level="machine", causes=causes, pictures={"ranking": rows})
    marked = as_named(report).pictures["ranking"]
    assert [row["named"] for row in marked] == [False, True]  # type: ignore[attr-defined]
    assert as_named(Report(verdict="explained", sentence="", level="machine")).pictures == {}
