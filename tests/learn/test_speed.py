import numpy as np
import pytest

from learn.assess import estimated
from learn.looked import stretches
from learn.orders import of_ratio
from learn.speed import USUAL_ERROR, candidates
from learn.tacho import pulses_of
from signals.recording import Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE = 10_000.0


def turning(speed, seconds=6.0, seed=0):
    t = np.arange(int(RATE * seconds)) / RATE
    lines = sum(a * np.sin(2 * np.pi * k * speed * t + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    return lines + 0.5 * np.random.default_rng(seed).standard_normal(t.size)


@pytest.mark.parametrize("speed", [13.0, 28.7, 41.3])
def test_harmonics_give_the_speed_near_a_stated_one_and_alone(speed):
    (near,) = candidates([turning(speed)], RATE, 1.03 * speed)
    assert near.speed_hz == pytest.approx(speed, rel=3e-3)
    assert near.method == "lines"
    assert candidates([turning(speed)], RATE, None)[0].speed_hz == pytest.approx(speed, rel=3e-3)


def test_without_any_line_the_stated_speed_is_kept():
    noise = np.random.default_rng(1).standard_normal(30_000)
    found = estimated([noise], RATE, 25.0, of_ratio(9, 0.2))
    assert (found.speed_hz, found.method, found.doubt) == (25.0, "stated", USUAL_ERROR)
    assert 24.0 < found.likely[0] < found.likely[1] < found.likely[2] < 26.0


def test_modulation_alone_gives_the_speed_more_finely_the_longer_it_is_heard():
    rng = np.random.default_rng(4)
    found = []
    for seconds in (1.0, 8.0):
        t = np.arange(int(RATE * seconds)) / RATE
        noise = rng.standard_normal(t.size) * (1 + 0.8 * np.cos(2 * np.pi * 21.3 * t))
        found += candidates([noise], RATE, 21.0)
    assert found[1].doubt < found[0].doubt
    assert found[1].speed_hz == pytest.approx(21.3, rel=3e-3)


def test_the_likeliest_speed_from_nothing_is_not_a_fraction_of_the_true_one():
    assert candidates([turning(40.0)], RATE, None)[0].speed_hz == pytest.approx(40.0, rel=3e-3)


def test_pulses_come_first():
    recording = Recording(
        sampling_rate_hz=RATE,
        channels=(Channel(name="a", quantity="acceleration", unit="g", location="", axis=""),),
        samples=np.zeros((1, 10)),
        tacho=Tacho(shaft="s", pulse_times_s=np.arange(50) / 40.0, pulses_per_revolution=2),
    )
    assert pulses_of(recording).speed_hz == pytest.approx(20.0)


def test_stretches_are_equal_and_not_too_long():
    parts = stretches([np.zeros(100_000), np.zeros(100_000)], 10_000.0, 20.0)
    assert len(parts) == 10
    assert {c.size for p in parts for c in p} == {10_000}


def test_too_few_turns_are_refused():
    with pytest.raises(SpecError, match="too few turns"):
        stretches([np.zeros(1000)], 10_000.0, 20.0)


@pytest.mark.parametrize("samples", [8, 40, 60])
def test_a_recording_far_too_short_for_a_speed_is_refused(samples):
    with pytest.raises(SpecError, match="too few turns"):
        estimated([np.random.default_rng(0).standard_normal(samples)], 1000.0, 20.0, None)
    with pytest.raises(SpecError, match="too few turns"):
        estimated([np.random.default_rng(0).standard_normal(samples)], 1000.0, None, None)
