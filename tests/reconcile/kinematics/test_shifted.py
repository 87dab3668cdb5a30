"""What a unit did to the levels beside a defect is told; what the defect did to them is said without that doubt."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.gate.findings import Finding, Gate, Kind
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.shifted import with_shifted
from reconcile.report.action import UNIT_OR_GAIN, to_do
from reconcile.verdict import Cause, Report
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.response import Channel
from tests.strategies import brief

RATE_HZ, N, G = 20_000.0, 40_000, 9.80665
NAMED = Report(
    verdict="explained",
    sentence="A pit.",
    level="kinematics",
    causes=(Cause(term="outer_spall", site="bearing1", severity=None, score=9.0, named=True),),
)


def heard(seed: int, count: int, blow: float = 0.0) -> FloatArray:
    """Noise of each channel, with what rings at 3 kHz and half as loud over all frequencies."""
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal((count, N))
    blows = np.zeros(N)
    blows[::200] = 30.0 * blow
    time = np.arange(400) / RATE_HZ
    ring = np.convolve(blows, np.exp(-800 * time) * np.sin(2 * np.pi * 3000 * time))[:N]
    return np.asarray(noise + ring + 0.5 * blow * rng.standard_normal((count, N)), dtype=np.float64)


def seen(
    rows: FloatArray, speed_hz: float = 20.0, last: str = "acceleration", rate_hz: float = RATE_HZ
) -> SimpleNamespace:
    names = ("de", "fe", "xe", "ye", "ze")[: rows.shape[0]]
    kinds = [*["acceleration"] * (len(names) - 1), last]
    channels = tuple(
        Channel(name=n, quantity=kind, unit="m/s^2", location="", axis="") for n, kind in zip(names, kinds, strict=True)
    )
    return SimpleNamespace(
        recording=Recording(sampling_rate_hz=rate_hz, channels=channels, samples=rows),
        speed=SimpleNamespace(speed_hz=speed_hz),
    )


def told(rows: FloatArray, *, kind: Kind | None = None, speed_hz: float = 20.0, report: Report = NAMED) -> Report:
    found = () if kind is None else (Finding(kind=kind, channel="de", recording="", detail="", severity=1, fault=True),)
    gate = Gate(findings=found, baselines=(), tests=(), fault=None, usable=True)
    base = seen(heard(1, rows.shape[0]))
    return with_shifted(report, gate, [seen(rows, speed_hz)], [base])  # type: ignore[list-item]


def times(rows: FloatArray, *factors: float) -> FloatArray:
    return np.asarray(rows * np.array(factors)[:, np.newaxis])


@pytest.mark.parametrize(
    ("factors", "changed", "names"),
    [
        ((1 / G, 1.0), "of de against fe changed by -20 dB", "of de may"),
        ((1.0, 1 / G), "of fe against de changed by -20 dB", "of fe may"),
        ((G, 1.0), "changed by", "of de or fe may"),  # either: nothing fell
        ((1.0, 1 / G, 1.0), "of fe against the other channels changed by -20 dB", "of fe may"),
        ((1.0, 1.0, G), "of xe against the other channels changed by +20 dB", "of xe may"),
        ((1 / G, 1 / G, 1.0), "of xe against the other channels changed by +20 dB", "of de and fe may"),  # they fell
        ((1 / G, 1 / G, 1.0, 1.0), "against the other channels changed by -20 dB", "of de and fe may"),
        ((G, G, 1.0), "of xe against the other channels changed by -20 dB", "of xe, or of de and fe, may"),
        ((G, G, 1.0, 1.0), "against the other channels changed by +20 dB", "of de and fe, or of xe and ye, may"),
        ((G, G, 1.0, 1.0, 1.0), "against the other channels changed by +20 dB", "of de and fe may"),
    ],
)
def test_one_channel_in_another_unit_is_told_beside_a_defect(
    factors: tuple[float, ...], changed: str, names: str
) -> None:
    report = told(times(heard(2, len(factors), 2.0), *factors))
    assert changed in report.sentence and "19.8 dB is the ratio of g against m/s^2" in report.sentence
    assert f"{UNIT_OR_GAIN} {names} be wrong" in report.sentence
    assert "check unit and gain of every channel" in to_do(report)


@pytest.mark.parametrize("factors", [(1.0, 1.0), (1.5, 0.8), (4.0, 1.0), (1.0, 30.0)])
def test_other_gains_and_a_defect_alone_are_no_unit(factors: tuple[float, ...]) -> None:
    report = told(times(heard(2, 2, 2.0), *factors))
    assert report.sentence == NAMED.sentence


def test_what_another_quantity_does_not_hear_is_no_unit() -> None:
    """A race may raise all of an acceleration evenly by as much, and moves no current."""
    gate = Gate(findings=(), baselines=(), tests=(), fault=None, usable=True)
    louder = times(heard(2, 2), G, 1.0)
    for last, alike in (("acceleration", True), ("current", False)):
        both = [seen(louder, last=last)], [seen(heard(1, 2), last=last)]
        assert ("changed by" in with_shifted(NAMED, gate, *both).sentence) is alike  # type: ignore[arg-type]


def test_all_channels_in_another_unit_are_a_limit_with_the_levels() -> None:
    (limit,) = told(times(heard(2, 2, 0.4), 1 / G, 1 / G)).where.limits
    assert "de -" in limit and "fe -" in limit and "a defect takes nothing away" in limit
    assert f"unless the load was smaller, {UNIT_OR_GAIN} of de and fe may be wrong" in limit
    nothing = replace(NAMED, verdict="nothing_missing", causes=())
    quiet = told(times(heard(2, 2), 1 / 4, 1 / 4), report=nothing)
    assert "check unit and gain" in to_do(quiet) and "keep them" not in to_do(quiet)
    assert "keep them" in to_do(nothing)


def test_a_level_that_rose_far_is_told_and_doubted_only_near_a_unit() -> None:
    (alone,) = told(heard(2, 1, 12.0)).where.limits
    assert alone.startswith("levels against the baseline: de +") and UNIT_OR_GAIN not in alone
    (near,) = told(times(heard(2, 1), G)).where.limits
    assert f"19.8 dB is the ratio of g against m/s^2: {UNIT_OR_GAIN} of de may" in near
    assert told(heard(2, 2, 1.0)) == NAMED, "a pit that is usual"


def test_no_word_of_it_where_levels_cannot_be_held_against_each_other() -> None:
    wrong = times(heard(2, 2, 2.0), 1 / G, 1.0)
    assert told(wrong, kind="clipped") == NAMED and told(wrong, speed_hz=30.0) == NAMED
    assert told(wrong, kind="loose_sensor") != NAMED
    other = [seen(heard(1, 2), rate_hz=RATE_HZ / 2)]
    gate = Gate(findings=(), baselines=(), tests=(), fault=None, usable=True)
    assert with_shifted(NAMED, gate, [seen(wrong)], other) == NAMED  # type: ignore[list-item, arg-type]
    assert with_shifted(NAMED, gate, [seen(wrong)], []) == NAMED  # type: ignore[list-item]
    fault = replace(NAMED, verdict="measurement_fault")
    assert told(wrong, report=fault) == fault


@pytest.mark.slow
def test_the_whole_answer_tells_levels_that_fell_on_all_channels_and_keeps_no_such_recording() -> None:
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
    machine = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    base, test = (brief.recorded(np.array([brief.sound(k), brief.sound(k + 10)])) for k in (5, 2))
    fallen = replace(test, samples=np.asarray(test.samples / 4))
    report = reconcile_kinematics(machine, [fallen], [base], seed=1)
    assert report.verdict == "nothing_missing" and "load, speed or mounting" in report.sentence
    assert any("unless the load was smaller" in limit for limit in report.where.limits)
    assert "check unit and gain" in to_do(report)
