"""Sidebands of one shaft at one number of turns that rise together are seen though each is lost among the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from reconcile.judge.metric import Whitening
from reconcile.judge.turns import FORM, LEAST_DB, SOFTNESS, Turned, evidence_of_turns, sidebands, turned
from reconcile.machine.decide import CLEAR_P
from reconcile.observe.watch import WatchList, watch_list
from reconcile.tail import tail_chance
from signals.series import FloatArray
from sim.presets import preset
from tests.reconcile.judge.toothed import (
    CHANNELS,
    FEATURES,
    GROUPS,
    HARMONICS,
    POINTS,
    SHAPE,
    SIGMA_DB,
    SPEEDS,
    WATCH,
    WHITEN,
    own,
    raised,
    sound,
)

SOUND = sound()
EACH = 0.97
"""Deviations by which each member rises."""
RISE_DB = EACH * SIGMA_DB
MEMBERS = 2 * HARMONICS


def seen(
    observed: FloatArray,
    rest: FloatArray = SOUND,
    whiten: Whitening = WHITEN,
    speeds: Sequence[Sequence[int]] = SPEEDS,
) -> Turned:
    return turned(WATCH, observed, rest, whiten, speeds, CHANNELS)


def noise(seed: int) -> FloatArray:
    return np.random.default_rng([seed, 1]).normal(0.0, SIGMA_DB, WHITEN.sigma.size)


@pytest.mark.parametrize(("shaft", "turns"), GROUPS)
def test_what_no_single_one_shows_all_of_them_do(shaft: str, turns: int) -> None:
    observed = noise(GROUPS.index((shaft, turns))) + raised(shaft, turns, RISE_DB)
    usual = np.quantile(np.abs(WHITEN(SOUND)).max(axis=1), 0.95)
    assert np.abs(WHITEN(observed)).max() < usual, "no line is more unusual than one of sound machines"
    found = seen(observed)
    assert (found.shaft, found.turns) == (shaft, turns)
    assert found.p <= CLEAR_P
    assert found.rise_db == pytest.approx(RISE_DB, abs=1.3)


def test_what_sound_machines_show_is_not_clear() -> None:
    found = [seen(noise(seed)) for seed in range(40)]
    assert min(one.p for one in found) > CLEAR_P


def test_the_chance_is_that_of_any_group() -> None:
    """In so many groups one or another comes as far by chance."""
    observed = raised("f_r1", 1, 0.5 * RISE_DB + 0.3)
    found = seen(observed)
    groups = sidebands(WATCH)
    changes = np.concatenate([observed[None], SOUND])
    both = np.sort(groups.rises(changes, WHITEN, POINTS, CHANNELS).sum(axis=2), axis=1)[:, -2]
    scaled = (both - both[1:].mean(axis=0)) / both[1:].std(axis=0)
    assert found.rise_db > LEAST_DB
    assert found.p == pytest.approx(tail_chance(scaled[1:].max(axis=1), float(scaled[0, 0])))
    assert found.p > 2.0 * tail_chance(scaled[1:, 0], float(scaled[0, 0]))


def test_some_that_rise_and_some_that_fall_are_nothing() -> None:
    for wrong in (own("f_r1", 1)[::2], own("f_r1", 1)[: MEMBERS // 2]):
        cube = raised("f_r1", 1, 4.0 * SIGMA_DB).reshape(*SHAPE, FEATURES)
        cube[..., wrong] *= -1.0
        found = seen(cube.ravel())
        assert found.rise_db == pytest.approx(0.0, abs=1e-9) and found.p == 1.0


def test_a_fall_is_nothing() -> None:
    found = seen(raised("f_r1", 1, -4.0 * SIGMA_DB))
    assert found.p == 1.0 and found.rise_db <= 0.0 and (found.shaft, found.turns) != ("f_r1", 1)


def test_one_speed_may_be_a_resonance_and_two_are_not() -> None:
    assert seen(raised("f_r1", 1, 6.0 * SIGMA_DB, points=(1,))).p == 1.0
    two = seen(raised("f_r1", 1, RISE_DB, points=(0, 2)))
    assert two.p <= CLEAR_P and two.rise_db == pytest.approx(RISE_DB)


def test_two_points_of_one_speed_are_one() -> None:
    """Each speed by its largest point."""
    loads = ((0, 1), (2,))
    assert seen(raised("f_r1", 1, 6.0 * SIGMA_DB, points=(0, 1)), speeds=loads).p == 1.0
    apart = seen(raised("f_r1", 1, RISE_DB, points=(1, 2)), speeds=loads)
    assert apart.p <= CLEAR_P and apart.rise_db == pytest.approx(RISE_DB)
    assert seen(raised("f_r1", 1, 6.0 * SIGMA_DB), speeds=((0, 1, 2),)) == Turned()


def test_a_machine_without_teeth_has_no_sidebands() -> None:
    bare = WatchList(lines=tuple(line for line in WATCH.lines if line.family != "sideband"), modulations=())
    size = POINTS * CHANNELS * len(bare.lines)
    whiten = Whitening(sigma=np.ones(size))
    assert turned(bare, np.full(size, 30.0), np.zeros((20, size)), whiten, SPEEDS, CHANNELS) == Turned()


def test_a_rise_is_told_from_a_level_on_however_rare() -> None:
    quiet, fine = SOUND * 0.05, Whitening(sigma=0.05 * WHITEN.sigma)
    below = seen(raised("f_r2", 2, LEAST_DB - 0.01), quiet, fine)
    assert (below.p, below.shaft, below.turns) == (1.0, "f_r2", 2) and below.rise_db == pytest.approx(LEAST_DB - 0.01)
    above = seen(raised("f_r2", 2, LEAST_DB + 0.01), quiet, fine)
    assert above.p <= CLEAR_P and above.rise_db == pytest.approx(LEAST_DB + 0.01)


def test_what_sound_machines_always_show_is_usual() -> None:
    always = raised("f_r1", 3, RISE_DB)
    assert seen(always + noise(3), SOUND + always).p > 0.01
    found = seen(always + raised("f_r2", 1, RISE_DB), SOUND + always)
    assert (found.shaft, found.turns) == ("f_r2", 1), "more than usual, though not more than the other"


def test_a_group_that_wanders_hides_itself_and_no_other() -> None:
    wander = np.random.default_rng(8).normal(size=(SOUND.shape[0], 1)) * raised("f_r1", 1, 3.0 * SIGMA_DB)
    assert seen(raised("f_r1", 1, RISE_DB), SOUND + wander).p > 0.01
    other = seen(raised("f_r2", 1, RISE_DB), SOUND + wander)
    assert other.p <= CLEAR_P and (other.shaft, other.turns) == ("f_r2", 1)


def test_what_was_not_measured_counts_for_nothing() -> None:
    cube = raised("f_r1", 2, RISE_DB).reshape(*SHAPE, FEATURES)
    cube[:, :, own("f_r1", 2)[:6]] = np.nan
    found = seen(cube.ravel())
    assert found.rise_db == pytest.approx(RISE_DB / 2)
    sigma = np.where(raised("f_r1", 2, 1.0) > 0, np.inf, SIGMA_DB)
    assert seen(raised("f_r1", 2, 10.0), whiten=Whitening(sigma=sigma)).p > 0.01


def test_a_mean_rise_is_in_units_of_its_own_noise() -> None:
    groups = sidebands(WATCH)
    together = groups.rises(raised("f_r2", 3, RISE_DB, points=(1,))[None], WHITEN, POINTS, CHANNELS)
    assert together.shape == (1, POINTS, CHANNELS, len(GROUPS))
    wanted = np.zeros(together.shape)
    wanted[0, 1, :, GROUPS.index(("f_r2", 3))] = EACH * np.sqrt(MEMBERS)
    np.testing.assert_allclose(together, wanted, atol=1e-12)


def test_groups_are_the_sidebands_of_each_shaft_and_number_of_turns() -> None:
    groups = sidebands(WATCH)
    assert groups.names == GROUPS
    for (shaft, turns), members in zip(groups.names, groups.members, strict=True):
        assert sorted(members) == sorted(own(shaft, turns)) and members.size == MEMBERS
    real = watch_list(preset("paper-lightly-damped"))
    found = sidebands(real)
    assert sorted(found.names) == sorted(GROUPS)
    for (shaft, turns), members in zip(found.names, found.members, strict=True):
        assert {abs(real.lines[k].orders[shaft]) for k in members} == {turns}
        assert {real.lines[k].family for k in members} == {"sideband"}


def evidence(observed: FloatArray, rows: dict[str, list[FloatArray]], rest: FloatArray) -> dict[str, float]:
    drawn: list[FloatArray] = []
    groups: dict[str, tuple[int, ...]] = {}
    for name, changes in rows.items():
        groups[name] = tuple(range(len(drawn), len(drawn) + len(changes)))
        drawn += changes
    return evidence_of_turns(WATCH, observed, rest, np.stack(drawn), groups, WHITEN, SHAPE)


def closed(each: float, cells: int) -> float:
    """Of a perfect match: so many cells, each risen by so many units of its noise."""
    return cells * (each**2 - float(np.log(1.0 + (FORM * each) ** 2))) / (2.0 * SOFTNESS)


@pytest.mark.parametrize("wide", [0.0, 3.0])
def test_a_perfect_match_has_the_evidence_of_the_closed_form(wide: float) -> None:
    """Where sound machines scatter more than lines of their own would, a rise counts for less."""
    two = np.array([[1.0], [-1.0]]) * sum(raised(*one, SIGMA_DB) for one in GROUPS)
    rest = wide * two / np.sqrt(MEMBERS)
    observed = raised("f_r1", 2, RISE_DB)
    found = evidence(observed, {"it": [observed], "nothing": [np.zeros(observed.size)]}, rest)
    each = EACH * np.sqrt(MEMBERS) / max(wide, 1.0)
    assert found["it"] == pytest.approx(closed(each, POINTS * CHANNELS))
    assert found["nothing"] == pytest.approx(0.0)


def test_what_sound_machines_always_raise_speaks_for_no_effect() -> None:
    always, observed = raised("f_r2", 1, RISE_DB), raised("f_r1", 2, RISE_DB)
    found = evidence(observed + always, {"it": [observed], "usual": [always]}, np.stack([always, always]))
    assert found["it"] == pytest.approx(closed(EACH * np.sqrt(MEMBERS), POINTS * CHANNELS)) and found["usual"] < 0


def test_the_effect_that_raises_the_same_comes_first() -> None:
    observed = raised("f_r1", 2, RISE_DB)
    found = evidence(
        observed,
        {
            "other turns": [raised("f_r1", 1, RISE_DB)],
            "alike": [observed],
            "other shaft": [raised("f_r2", 2, RISE_DB)],
            "both": [raised("f_r1", 2, RISE_DB) + raised("f_r2", 2, RISE_DB)],
            "one point": [raised("f_r1", 2, RISE_DB, points=(0,))],
            "falls": [-observed],
        },
        np.zeros((2, observed.size)),
    )
    assert max(found, key=lambda name: found[name]) == "alike"
    assert found["other turns"] < 0 and found["other shaft"] < 0 and found["falls"] < 0
    assert found["one point"] == pytest.approx(found["alike"] / POINTS)
    assert 0 < found["both"] < found["alike"]


def test_an_effect_has_the_mean_of_what_its_draws_say_of_it() -> None:
    """So that one of which more are simulated is no likelier, and no draw says more than a match."""
    observed = raised("f_r1", 2, RISE_DB)
    few = [raised("f_r1", 2, share * RISE_DB) for share in (0.2, 1.0, 4.0)]
    rows = {"few": few, "many": 5 * few, **{str(k): [one] for k, one in enumerate(few)}}
    found = evidence(observed, rows, np.zeros((2, observed.size)))
    assert found["few"] == pytest.approx(float(np.log(np.mean(np.exp([found[str(k)] for k in range(3)])))))
    assert found["many"] == pytest.approx(found["few"])
    assert found["few"] < found["1"] == pytest.approx(closed(EACH * np.sqrt(MEMBERS), POINTS * CHANNELS))


def test_an_effect_that_is_a_third_too_large_is_within_its_form() -> None:
    """A deviation of the share that a law's form may be wrong costs half a unit a cell, not all it is in noise."""
    each = 10.0
    unit = each * SIGMA_DB / np.sqrt(MEMBERS)
    observed, drawn = raised("f_r1", 1, unit), raised("f_r1", 1, unit / (1.0 + FORM))
    found = evidence(observed, {"it": [drawn]}, np.zeros((2, observed.size)))["it"]
    size = each / (1.0 + FORM)
    variance = 1.0 + (FORM * size) ** 2
    cell = each**2 - (each - size) ** 2 / variance - float(np.log(variance))
    assert found == pytest.approx(POINTS * CHANNELS * cell / (2.0 * SOFTNESS))
