"""A burst at one tooth is found through all channels and bands; what is not at one tooth is none."""

import numpy as np
import pytest

from reconcile.observe.whole_turn import Turned, standing, whole_turns

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


def turned(samples, turns=TURNS):
    return Turned(samples=samples, turns=turns[: samples.shape[1]])


def turn(samples, turns=TURNS, teeth=(TEETH,)):
    return whole_turns(turned(samples, turns), None, teeth=teeth)[0]


def stands(now, before, turns=TURNS, teeth=(TEETH,)):
    return standing(*whole_turns(turned(now, turns), turned(before, turns), teeth=teeth))


@pytest.mark.parametrize("at", [0.02, 0.4, 0.99])
def test_a_burst_below_the_noise_is_found_at_its_place(at):
    struck = sound(1)
    struck[1] += burst(TURNS, at, size=0.6)
    found = turn(struck)
    assert stands(struck, sound(2)) > 1.0
    off = (found.at / found.windows.size - at + 0.5) % 1.0 - 0.5
    assert -0.5 / TEETH < off < 1.5 / TEETH


def test_sound_turns_stand_out_of_each_other_by_nothing():
    told = [stands(sound(k), sound(k + 1)) for k in range(0, 24, 2)]
    assert max(told) < 0.6
    assert np.median(told) < 0.2


def test_what_is_heard_for_a_third_of_the_turn_is_no_tooth():
    rattle = sound(3)
    for k in range(9):
        rattle += burst(TURNS, 0.3 + 0.035 * k, size=0.6 * (1 - 0.08 * k))
    assert stands(rattle, sound(4)) < 0.3


def test_uneven_teeth_are_no_faulty_one():
    rng = np.random.default_rng(5)
    uneven = sound(5)
    for k, size in enumerate(rng.uniform(0.3, 1.0, TEETH)):
        uneven += burst(TURNS, k / TEETH, size=size)
    assert stands(uneven, sound(6)) < 0.3


def test_balls_are_in_step_with_no_turn():
    balls = sound(7) + burst(TURNS * 3.5731, 0.1, size=1.0)
    assert stands(balls, sound(8)) < 1.0


def test_lines_of_a_faster_shaft_do_not_hide_it():
    ratio, teeth = 23 / 81, 81
    slow = TURNS * ratio
    strong, before = sound(9), sound(10)
    lines = sum(0.5 * np.sin(2 * np.pi * k * TURNS + k) for k in range(1, 40))
    strong, before = strong + lines, before + lines
    assert stands(strong, before, slow, (teeth,)) < 0.8
    strong += burst(slow, 0.6, size=1.2, turn_hz=HZ * ratio)
    assert stands(strong, before, slow, (teeth,)) > 1.0


def test_the_turn_may_wander_and_begin_late():
    turns = TURNS + 0.1 * np.sin(2 * np.pi * 2.0 * TIME)
    struck = np.array([burst(turns, 0.25, size=0.6)] * 3) + 0.3 * np.random.default_rng(11).standard_normal(
        (3, TIME.size)
    )
    late = turns.copy()
    late[:500] = np.nan
    found = turn(struck, late)
    start = late[500] % 1.0
    assert ((found.at / found.windows.size + start - 0.25 + 0.5) % 1.0 - 0.5) * TEETH == pytest.approx(0.3, abs=0.8)


@pytest.mark.parametrize("samples, rate", [(2600, 1.0), (TIME.size, 12.0)])
def test_too_few_turns_or_too_slow_a_rate_tell_nothing(samples, rate):
    assert turn(sound(12)[:, :samples], TURNS * rate) is None
    assert standing(None, None) == 0.0


def test_silence_and_unknown_angles_tell_nothing():
    assert turn(np.zeros((1, TIME.size))) is None
    assert turn(sound(13), np.full(TIME.size, np.nan)) is None


def test_without_a_baseline_the_usual_height_stands_for_it():
    struck = sound(14)
    struck += burst(TURNS, 0.5, size=0.6)
    assert standing(turn(struck), None) > 1.0
    assert standing(turn(sound(15)), None) < 0.3


def odd(seed, size=1.0, noise=0.3, ring=0.4):
    """One tooth a little odd; all of it times `size` but the noise."""
    rng = np.random.default_rng(seed)
    mesh = sum(np.sin(2 * np.pi * TEETH * k * TURNS + k) / k for k in (1, 2, 3))
    return size * (mesh + burst(TURNS, 0.5, size=ring)) + noise * rng.standard_normal((2, TIME.size))


def test_a_longer_test_is_cut_to_the_turns_of_its_baseline():
    now, before = whole_turns(turned(odd(16)), turned(odd(17)[:, : TIME.size // 4]), teeth=(TEETH,))
    assert now.turns == before.turns == 8
    assert standing(now, before) < 0.6


@pytest.mark.parametrize("how", [{"noise": 0.1}, {"size": 2.0}, {"size": 3.0, "noise": 0.2}])
def test_an_odd_tooth_of_the_baseline_is_no_fault_of_a_quieter_or_louder_test(how):
    told = [stands(odd(k, **how), odd(k + 50)) for k in range(6)]
    assert np.median(told) < 0.4 and max(told) < 1.0
    grown = [stands(odd(k, ring=1.5), odd(k + 50)) for k in range(3)]
    assert min(grown) > 1.0, "but where it has grown it is"


@pytest.mark.parametrize(("turns", "size"), [(8, 10.0), (16, 10.0), (35, 20.0)])
def test_one_knock_comes_back_in_no_other_turn(turns, size):
    cut = slice(0, int(turns * RATE / HZ) + 2)
    for seed in range(4):
        knocked, before = sound(seed)[:, cut], sound(seed + 30)[:, cut]
        at = 2000 + 400 * seed
        knocked[:, at : at + 200] += size * np.exp(-np.arange(200) / 20) * np.sin(np.arange(200) * 0.94)
        assert stands(knocked, before) < 1.0


def test_of_unlike_rates_both_are_heard_in_the_same_band():
    """The odd tooth rings at 6.5 kHz, above what the baseline's rate reaches."""
    now, before = sound(18), sound(19)
    ring = burst(TURNS, 0.5, size=1.0, hz=6500.0)
    half = Turned(samples=(before + ring)[:, ::2], turns=TURNS[::2])
    assert standing(*whole_turns(turned(now + ring), half, teeth=(TEETH,))) < 0.8


@pytest.mark.parametrize("held", [0.0, 5.0])
def test_a_channel_that_holds_one_value_in_either_hides_nothing(held):
    struck, before = sound(20), sound(21)
    struck[1] += burst(TURNS, 0.5, size=0.6)
    for dead in (struck.copy(), before.copy()):
        dead[2] = held
        pair = (dead, before) if dead[1, 0] == struck[1, 0] else (struck, dead)
        assert stands(*pair) > 0.8
    assert stands(np.full((2, TIME.size), held), before[:2]) == 0.0
