"""Knocks that keep their time, not their angle, are no part's; knocks of a part are left alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from reconcile.machine.own_knocks import OwnKnocks, knocks_of, own_knocks
from reconcile.machine.strange import explained_by, with_strange
from reconcile.observe.steady import Steady
from reconcile.speed import SpeedEstimate
from reconcile.verdict import Cause, Report, Where
from sim.core.response import Channel
from sim.presets import preset

RATE_HZ, SECONDS = 20_000.0, 1.2
SPEEDS_HZ = (20.0, 25.0, 33.0)
CHANNELS = tuple(
    Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"bearing{k + 1}") for k in range(2)
)
pytestmark = pytest.mark.slow


@dataclass(frozen=True)
class Seen:
    """As much of a point's data as is looked at."""

    spectra: tuple[Steady, Steady | None]


def steady(speed_hz: float, every_s: float | None, seed: int, late: float = 0.13) -> Steady:
    """Noise, and knocks that ring at 3 kHz, every third late, louder on the second channel."""
    rng = np.random.default_rng(seed)
    n = int(RATE_HZ * SECONDS)
    rows = 0.05 * rng.standard_normal((2, n))
    t = np.arange(400) / RATE_HZ
    ring = np.exp(-t / 1.5e-3) * np.sin(2 * np.pi * 3_000.0 * t)
    at = np.arange(0.02, SECONDS - 0.05, every_s) if every_s else ()
    for k, start in enumerate(at):
        place = int(RATE_HZ * (start + (late * every_s if every_s and k % 3 == 0 else 0.0)))
        for row, size in enumerate((1.0, 4.0)):
            rows[row, place : place + ring.size] += size * ring
    found = SpeedEstimate(
        shaft="input", speed_hz=speed_hz, low_hz=speed_hz, high_hz=speed_hz, confidence=1.0, method="tacho",
        stated_hz=speed_hz,
    )  # fmt: skip
    return Steady(samples=rows, rate_hz=RATE_HZ, speed_hz=speed_hz, estimate=found)


def data(every_s, before=lambda _: None, speeds=SPEEDS_HZ):  # type: ignore[no-untyped-def]
    return [
        Seen(spectra=(steady(hz, every_s(hz), 2 * k), steady(hz, before(hz), 2 * k + 1))) for k, hz in enumerate(speeds)
    ]


def test_knocks_in_their_own_time_are_told_with_their_rate_and_place() -> None:
    found = own_knocks(data(lambda _: 1.0 / 15.0), CHANNELS)  # type: ignore[arg-type]
    assert found is not None
    assert found.hz == pytest.approx(15.0, rel=0.02)
    assert (found.channel, found.location) == ("a1", "bearing2")
    assert "15.1 times a second" in found.text and "20, 25, 33 Hz" in found.text
    assert [(p.site, p.weight) for p in found.sites(preset("rotor"))] == [("bearing2", 1.0)]
    assert found.sites(preset("bearing-rig")) == (), "no bearing of that name"


@pytest.mark.parametrize("order", [0.6, 1.0, 3.58 / 4])
def test_knocks_at_an_order_are_a_parts(order: float) -> None:
    assert own_knocks(data(lambda hz: 1.0 / (order * hz)), CHANNELS) is None  # type: ignore[arg-type]


def test_the_baselines_own_knocks_and_one_speed_tell_nothing() -> None:
    old = data(lambda _: 1.0 / 15.0, lambda _: 1.0 / 15.0)
    assert own_knocks(old, CHANNELS) is None  # type: ignore[arg-type]
    near = data(lambda _: 1.0 / 15.0, speeds=(24.0, 25.0))
    assert own_knocks(near, CHANNELS) is None  # type: ignore[arg-type]
    alone = [replace(one, spectra=(one.spectra[0], None)) for one in data(lambda _: 1.0 / 15.0)]
    assert own_knocks(alone, CHANNELS) is None  # type: ignore[arg-type]


def test_a_baseline_too_short_or_with_uneven_knocks_of_its_own_makes_nothing_new() -> None:
    now = data(lambda _: 1.0 / 15.0)
    short = [
        Seen(spectra=(d.spectra[0], replace(d.spectra[1], samples=d.spectra[1].samples[:, :8_000])))  # type: ignore[type-var]
        for d in now
    ]
    assert own_knocks(short, CHANNELS) is None  # type: ignore[arg-type]
    uneven = [
        Seen(spectra=(d.spectra[0], steady(hz, 1.0 / 15.0, 40 + k, late=0.9)))
        for k, (d, hz) in enumerate(zip(now, SPEEDS_HZ, strict=True))
    ]
    assert own_knocks(uneven, CHANNELS) is None  # type: ignore[arg-type]


def test_a_glitch_stays_in_its_cable_and_a_lone_sensor_cannot_tell() -> None:
    alone = []
    for d in data(lambda _: 1.0 / 15.0):
        now = d.spectra[0]
        other = 0.05 * np.random.default_rng(3).standard_normal(now.samples.shape[1])
        alone.append(replace(d, spectra=(replace(now, samples=np.array([other, now.samples[1]])), d.spectra[1])))
    assert own_knocks(alone, CHANNELS) is None
    one = [
        replace(d, spectra=tuple(replace(s, samples=s.samples[1:]) for s in d.spectra))  # type: ignore[type-var]
        for d in alone
    ]
    found = own_knocks(one, CHANNELS[1:])
    assert found is not None and "glitches" in found.undecided[0]


@pytest.mark.parametrize(("apart", "told"), [(1.0, True), (1.08, False)])
def test_the_time_is_the_same_within_three_per_cent(apart: float, told: bool) -> None:
    found = own_knocks(data(lambda hz: (apart if hz == SPEEDS_HZ[2] else 1.0) / 15.0), CHANNELS)  # type: ignore[arg-type]
    assert (found is not None) == told


def test_noise_and_knocks_without_a_distance_are_none() -> None:
    assert knocks_of(steady(25.0, None, 5), 0) is None
    uneven = steady(25.0, 1.0 / 15.0, 5, late=0.9)
    assert knocks_of(uneven, 0) is None
    assert knocks_of(steady(25.0, 0.3, 5), 0) is None, "four knocks"


KNOCKS = OwnKnocks(hz=15.0, channel="a1", location="bearing2", speeds_hz=SPEEDS_HZ)


@pytest.mark.parametrize(
    ("term", "heard", "answers"),
    [
        ("ball_spall", {}, True),
        ("ball_spall", {"ball_spall@bearing2": 9.0}, False),
        ("unbalance", {}, False),
    ],
)
def test_a_name_that_strikes_and_is_not_heard_at_its_own_lines_gives_way(
    term: str, heard: dict[str, float], answers: bool
) -> None:
    causes = (Cause(term=term, site="bearing2", score=12.0, named=True),)
    report = Report(verdict="explained", sentence="so.", level="machine", causes=causes, where=Where())
    found = with_strange(report, KNOCKS, preset("rotor"), heard)
    assert (found.verdict == "unknown_physics") == answers
    assert ("15 times a second" in found.sentence) == answers
    assert explained_by(found) == (("fixed_tones",) if answers else ())
    assert [s.site for s in found.where.sites] == (["bearing2"] if answers else [])
