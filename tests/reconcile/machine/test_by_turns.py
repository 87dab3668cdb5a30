"""What rose together at a shaft's turns answers where nothing else is unusual, and only there."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.judge.adequacy import Rest
from reconcile.judge.screen import Screen
from reconcile.judge.turns import Turned
from reconcile.machine.by_turns import by_turns, clear, risen
from reconcile.machine.decide import BY_TURNS, CLEAR_P, DETECT_P, FAINT, LINES_QUIET, LOOKS, STRANGE, chance, decide
from tests.reconcile.judge import toothed
from tests.reconcile.machine.screens import screen, struck

NAMES = ("unbalance@pinion", "unbalance@gear", "rub@pinion")
QUIET: dict[str, Any] = {"p_any": 0.6, "p_best": 0.4, "strongest": 3.0}
CLEAR = Turned(p=0.5 * CLEAR_P, shaft="f_r1", turns=2, rise_db=3.0)
EACH = 0.97
SPEEDS_HZ = (20.0, 30.0, 40.0)


@pytest.fixture(autouse=True)
def few_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reconcile.machine.by_turns.watch_list", lambda _machine: toothed.WATCH)


def setting(
    observed: np.ndarray, *, with_baseline: bool = True, speeds_hz: tuple[float, ...] = SPEEDS_HZ, seed: int = 0
) -> Any:
    """Healthy pairs that hardly drift, and noise of a line's own size."""
    size = toothed.WHITEN.sigma.size
    changes = SimpleNamespace(
        with_baseline=with_baseline,
        observed=observed,
        null=0.01 * np.random.default_rng(2).normal(size=(24, size)),
        measured=toothed.WHITEN.sigma,
        wander=np.zeros((1, size)),
    )
    data = [SimpleNamespace(point=Point(speed_hz=hz)) for hz in speeds_hz]
    channels = range(toothed.CHANNELS)
    return SimpleNamespace(machine=None, changes=changes, data=data, channels=channels, seed=0)


def found(of: Screen) -> Any:
    """With draws of the first two effects, which raise one shaft's sidebands each; of the third there is none."""
    drawn = np.stack([toothed.raised(shaft, 2, EACH * toothed.SIGMA_DB) for shaft in ("f_r1", "f_r2")])
    library = SimpleNamespace(changes=drawn, groups={NAMES[0]: (0,), NAMES[1]: (1,)})
    empty = SimpleNamespace(library=SimpleNamespace(changes=drawn[::-1], groups={}))
    return SimpleNamespace(
        screen=of, fitted=SimpleNamespace(whiten=toothed.WHITEN), unled=SimpleNamespace(library=library), known=empty
    )


OBSERVED = toothed.raised("f_r1", 2, EACH * toothed.SIGMA_DB)


def told() -> Screen:
    """One on which everything stands that another look may have left."""
    made = screen([1.0, 2.0, 5.0], NAMES, misfit=1.0, rest=Rest(unmet=5.0, kept=0.1), **QUIET)
    left = {NAMES[0]: 1.0}
    return replace(
        made, direct=np.array([0.0, 1.0, 2.0]), unmoved=0.3, likelihoods=left, heard=left, yields=left, bursts=left
    )


def test_sound_machines_are_those_that_agree_with_the_baseline() -> None:
    seen = risen(setting(OBSERVED), found(told()).fitted)
    assert clear(seen) and (seen.shaft, seen.turns) == ("f_r1", 2)
    assert seen.rise_db == pytest.approx(EACH * toothed.SIGMA_DB)
    assert risen(setting(OBSERVED), found(told()).fitted) == seen, "the same seed, the same chance"
    assert not clear(risen(setting(np.zeros(OBSERVED.size)), found(told()).fitted))


def test_what_sound_machines_drift_by_is_usual() -> None:
    rng = np.random.default_rng(4)
    made = setting(OBSERVED)
    made.changes.null = rng.normal(size=(24, 1)) * toothed.raised("f_r1", 2, 3.0 * toothed.SIGMA_DB)
    assert not clear(risen(made, found(told()).fitted))
    fixed = by_turns(made, found(told()), CLEAR)
    assert fixed.evidence[0] < 0.5 * by_turns(setting(OBSERVED), found(told()), CLEAR).evidence[0]


def test_without_a_baseline_nothing_has_risen() -> None:
    assert risen(setting(OBSERVED, with_baseline=False), found(told()).fitted) == Turned()


def test_points_of_about_one_speed_are_one() -> None:
    same = setting(OBSERVED, speeds_hz=(30.0, 30.1, 30.2))
    assert risen(same, found(told()).fitted) == Turned()
    two = toothed.raised("f_r1", 2, 3.0 * toothed.SIGMA_DB, points=(0, 1))
    assert clear(risen(setting(two), found(told()).fitted))
    assert not clear(risen(setting(two, speeds_hz=(30.0, 30.1, 40.0)), found(told()).fitted))


def test_it_is_clear_up_to_a_chance() -> None:
    assert clear(Turned(p=CLEAR_P)) and not clear(Turned(p=1.01 * CLEAR_P)) and not clear(Turned())


def test_where_only_that_is_unusual_effects_count_by_it_alone() -> None:
    made = by_turns(setting(OBSERVED), found(told()), CLEAR)
    each = EACH * np.sqrt(2 * toothed.HARMONICS)
    cells = toothed.POINTS * toothed.CHANNELS
    perfect = cells * (each**2 - np.log(1.0 + (0.35 * each) ** 2)) / 16.0
    assert made.by_turns and made.p_turns == CLEAR.p
    assert made.evidence[0] == pytest.approx(perfect, rel=0.12), "noise is that of one line's"
    assert made.evidence[1] < 0.0 and made.evidence[2] == 0.0, "of what was not drawn nothing is known"
    np.testing.assert_allclose(made.weights, np.exp(made.evidence) / np.exp(made.evidence).sum())
    np.testing.assert_array_equal(made.direct, np.zeros(3))
    assert (made.misfit, made.rest, made.unmoved) == (0.0, Rest(), None)
    assert not (made.likelihoods or made.heard or made.yields or made.bursts)
    assert (made.p_any, made.p_best, made.strongest, made.names) == (0.6, 0.4, 3.0, NAMES)


def test_what_it_tells_is_near_and_names_nothing() -> None:
    decided = decide(by_turns(setting(OBSERVED), found(told()), CLEAR), views=6)
    assert (decided.word, decided.chosen, decided.reasons) == ("not_decidable", NAMES[:1], (BY_TURNS,))
    assert decided.p == pytest.approx(LOOKS * CLEAR.p)
    other = toothed.raised("f_r2", 2, EACH * toothed.SIGMA_DB)
    assert decide(by_turns(setting(other), found(told()), CLEAR), views=6).chosen == NAMES[1:2]
    assert decide(screen([20.0, 1.0], NAMES), views=6).word == "explained", "by a pattern it is named"
    set_of_two = replace(screen([20.0, 19.5], NAMES), by_turns=True)
    assert decide(set_of_two, views=6).word == "ambiguous"


def same(one: Screen, other: Screen) -> bool:
    """But for the chance of what rose together."""
    arrays = ("evidence", "direct", "weights", "by")
    kept = all(getattr(one, name) is getattr(other, name) for name in arrays)
    return kept and (one.misfit, one.rest, one.by_turns, one.unmoved) == (
        other.misfit,
        other.rest,
        False,
        other.unmoved,
    )


def test_a_chance_that_is_not_clear_is_noted_and_nothing_more() -> None:
    before = told()
    after = by_turns(setting(OBSERVED), found(before), replace(CLEAR, p=1.01 * CLEAR_P))
    assert same(after, before) and after.p_turns == 1.01 * CLEAR_P


@pytest.mark.parametrize(
    "unusual",
    [
        {"p_best": DETECT_P / LOOKS, "p_any": 0.04},
        {"p_direct": DETECT_P / LOOKS},
        {"p_lines": CLEAR_P},
        {"p_any": DETECT_P / LOOKS, "strongest": 15.0},
    ],
)
def test_what_another_look_has_found_stands(unusual: dict[str, float]) -> None:
    before = replace(told(), **unusual)  # type: ignore[arg-type]
    assert chance(before) == pytest.approx(min(DETECT_P, LOOKS * CLEAR_P) if "p_lines" in unusual else DETECT_P)
    after = by_turns(setting(OBSERVED), found(before), CLEAR)
    assert same(after, before) and after.p_turns == CLEAR.p


def test_what_another_look_has_not_quite_found_does_not_stand() -> None:
    before = replace(told(), p_direct=1.01 * DETECT_P / LOOKS)
    assert by_turns(setting(OBSERVED), found(before), CLEAR).by_turns


def test_a_fifth_look_counts_where_it_is_clear_alone() -> None:
    quiet = screen([1.0], **QUIET)
    assert chance(replace(quiet, p_turns=1.01 * CLEAR_P)) == 1.0
    assert chance(replace(quiet, p_turns=CLEAR_P)) == pytest.approx(LOOKS * CLEAR_P)
    assert chance(replace(quiet, p_turns=CLEAR_P, p_direct=0.1 * CLEAR_P)) == pytest.approx(0.4 * CLEAR_P)
    assert decide(replace(quiet, p_turns=1.01 * CLEAR_P), views=9).word == "nothing_missing"
    assert decide(replace(quiet, p_turns=CLEAR_P), views=9).word != "nothing_missing"


def test_it_is_not_too_faint_to_tell() -> None:
    """Of groups of features nothing is unusual there, and of what shows it the answer may be none of the known."""
    faint = screen([1.0, 0.5], **{**QUIET, "strongest": FAINT - 1.0}, p_turns=0.1 * CLEAR_P, lines_asked=False)
    assert "too faint" in decide(faint, views=9).reasons[0]
    by_it = decide(replace(faint, by_turns=True), views=9)
    assert by_it.word == "unknown_physics" and "faint" not in by_it.reasons[0]
    asked = decide(replace(faint, by_turns=True, lines_asked=True), views=9)
    assert (asked.word, asked.reasons) == ("not_decidable", (LINES_QUIET,)), "quiet lines say so still"


def test_impacts_are_not_all_that_tells() -> None:
    """Where they are, none of the effects that strike is excluded; what rose together excludes one."""
    made = struck([20.0, 9.0], [19.0, 18.0], strongest=3.0, p_any=0.6, p_best=0.4, p_direct=1e-5, misfit=STRANGE)
    made = replace(made, unmoved=0.4, p_turns=1e-5)
    assert "only impacts" in decide(made, views=9).reasons[0]
    assert decide(replace(made, by_turns=True), views=9).chosen == made.names[:1]
