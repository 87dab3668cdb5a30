"""A burst at one tooth is found through all channels and bands; what is not at one tooth is none."""

import numpy as np
import pytest

from reconcile.observe.whole_turn import of_as_many_turns, standing, whole_turn

RATE, HZ, TEETH, SECONDS = 20_000.0, 30.0, 23, 1.2
TIME = np.arange(int(RATE * SECONDS)) / RATE
TURNS = HZ * TIME


def sound(seed, channels=3):
    """Mesh lines, an unbalance and noise of a colour of its own on each channel."""
    rng = np.random.default_rng(seed)
    mesh = sum(np.sin(2 * np.pi * TEETH * k * TURNS + k) / k for k in (1, 2, 3))
    steady = mesh * (1 + 0.2 * np.sin(2 * np.pi * TURNS)) + np.sin(2 * np.pi * TURNS)
    noise = rng.standard_normal((channels, TIME.size))
    noise[0] = np.convolve(noise[0], [0.5, 0.5], "same")
    return steady + 0.3 * noise


def burst(turns, at, size=0.5, decay_s=1e-3, hz=3000.0, turn_hz=HZ):
    """One ring a turn, at `at` of it."""
    after = (turns - at) % 1.0 / turn_hz
    return size * np.exp(-after / decay_s) * np.sin(2 * np.pi * hz * after)


def turn(samples, **more):
    return whole_turn(samples, more.pop("turns", TURNS), teeth=more.pop("teeth", (TEETH,)), **more)


@pytest.mark.parametrize("at", [0.02, 0.4, 0.99])
def test_a_burst_below_the_noise_is_found_at_its_place(at):
    struck = sound(1)
    struck[1] += burst(TURNS, at, size=0.6)
    found = turn(struck)
    assert standing(found, turn(sound(2))) > 1.0
    off = (found.at / found.windows.size - at + 0.5) % 1.0 - 0.5
    assert -0.5 / TEETH < off < 1.5 / TEETH


def test_sound_turns_stand_out_of_each_other_by_nothing():
    told = [standing(turn(sound(k)), turn(sound(k + 1))) for k in range(0, 24, 2)]
    assert max(told) < 0.6
    assert np.median(told) < 0.2


def test_what_is_heard_for_a_third_of_the_turn_is_no_tooth():
    rattle = sound(3)
    for k in range(9):
        rattle += burst(TURNS, 0.3 + 0.035 * k, size=0.6 * (1 - 0.08 * k))
    assert standing(turn(rattle), turn(sound(4))) < 0.0


def test_uneven_teeth_are_no_faulty_one():
    rng = np.random.default_rng(5)
    uneven = sound(5)
    for k, size in enumerate(rng.uniform(0.3, 1.0, TEETH)):
        uneven += burst(TURNS, k / TEETH, size=size)
    assert standing(turn(uneven), turn(sound(6))) < 0.3


def test_balls_are_in_step_with_no_turn():
    balls = sound(7) + burst(TURNS * 3.5731, 0.1, size=1.0)
    assert standing(turn(balls), turn(sound(8))) < 1.0


def test_lines_of_a_faster_shaft_do_not_hide_it():
    ratio, teeth = 23 / 81, 81
    slow = TURNS * ratio
    strong, before = sound(9), sound(10)
    lines = sum(0.5 * np.sin(2 * np.pi * k * TURNS + k) for k in range(1, 40))
    strong, before = strong + lines, before + lines
    assert standing(turn(strong, turns=slow, teeth=(teeth,)), turn(before, turns=slow, teeth=(teeth,))) < 0.6
    strong += burst(slow, 0.6, size=1.2, turn_hz=HZ * ratio)
    assert standing(turn(strong, turns=slow, teeth=(teeth,)), turn(before, turns=slow, teeth=(teeth,))) > 1.0


def test_the_turn_may_wander_and_begin_late():
    turns = TURNS + 0.1 * np.sin(2 * np.pi * 2.0 * TIME)
    struck = np.array([burst(turns, 0.25, size=0.6)] * 3) + 0.3 * np.random.default_rng(11).standard_normal(
        (3, TIME.size)
    )
    late = turns.copy()
    late[:500] = np.nan
    found = turn(struck, turns=late)
    start = late[500] % 1.0
    assert ((found.at / found.windows.size + start - 0.25 + 0.5) % 1.0 - 0.5) * TEETH == pytest.approx(0.3, abs=0.8)


@pytest.mark.parametrize("samples, rate", [(2600, 1.0), (TIME.size, 12.0)])
def test_too_few_turns_or_too_slow_a_rate_tell_nothing(samples, rate):
    assert turn(sound(12)[:, :samples], turns=TURNS[:samples] * rate) is None
    assert standing(None, None) == 0.0


def test_silence_and_unknown_angles_tell_nothing():
    assert turn(np.zeros((1, TIME.size))) is None
    assert turn(sound(13), turns=np.full(TIME.size, np.nan)) is None


def test_without_a_baseline_the_usual_height_stands_for_it():
    struck = sound(14)
    struck += burst(TURNS, 0.5, size=0.6)
    assert standing(turn(struck), None) > 1.0
    assert standing(turn(sound(15)), None) < 0.3


def test_a_longer_test_is_cut_to_the_turns_of_its_baseline():
    """One tooth is a little odd in both: 35 turns bring it out of the noise, 8 do not."""
    odd, short = sound(16), sound(17)[:, : TIME.size // 4]
    odd, short = odd + burst(TURNS, 0.5, size=0.4), short + burst(TURNS[: TIME.size // 4], 0.5, size=0.4)

    def made(samples):
        return lambda most: turn(samples, turns=TURNS[: samples.shape[1]], most_turns=most)

    whole = standing(made(odd)(400), made(short)(400))
    now, before = of_as_many_turns(made(odd), made(short))
    assert now.turns == before.turns == 8
    assert standing(now, before) < 0.5 < whole
    assert of_as_many_turns(made(short), made(odd))[1].turns == 8
    assert of_as_many_turns(made(odd), lambda _: None)[0].turns == 35
