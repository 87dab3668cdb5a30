"""The next experiment: what the draws at hand say of it, and that it is not said where they do not."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.metric import Metric, Whitening
from reconcile.judge.pooled import OneByOne, Pooling
from reconcile.judge.space import Library
from reconcile.machine.answer import _lead, _next, _undecidable
from reconcile.machine.decide import Decision
from reconcile.machine.next_look import ADDS, Apart, apart_of, best_look, laid_out, unheard
from reconcile.machine.unknown import Unknown
from reconcile.machine.unlisted import UNLISTED
from reconcile.machine.words import DECIDES, next_experiment
from reconcile.verdict import EstimatedForce, NextExperiment
from sim.presets import preset

SPEEDS = (20.0, 30.0, 40.0)
CHANNELS = ("bearing1.y", "bearing3.y")
LINES = 4
SHAPE = (len(SPEEDS), len(CHANNELS))
SIZE = LINES * SHAPE[0] * SHAPE[1]
FIRST, SECOND, ELSEWHERE = "outer_spall@bearing1", "inner_spall@bearing1", "outer_spall@bearing2"
SCALE = 2.0
"""Overdispersion."""


def one_by_one() -> OneByOne:
    return OneByOne(chosen=np.ones(LINES, dtype=bool), points=SHAPE[0], channels=SHAPE[1])


def families() -> Pooling:
    family = np.array([0, 0, 1, 1])
    return Pooling(family=family, names=("a", "b"), points=SHAPE[0], channels=SHAPE[1])


def viewed(view: OneByOne | Pooling | None = None) -> SimpleNamespace:
    """A view whose metric weighs all directions alike."""
    view = view or one_by_one()
    size = view(np.zeros((1, SIZE))).shape[1]
    metric = Metric(centre=np.zeros(size), turn=np.eye(size))
    whiten = Whitening(sigma=np.ones(SIZE))
    return SimpleNamespace(
        view=view, whiten=whiten, metric=metric, overdispersion=SCALE, place=lambda x: metric(view(whiten(x[None])))[0]
    )


def differing(where: dict[tuple[int, int], float]) -> np.ndarray:
    """A pattern of 6 dB everywhere, and by so many dB another at some points and channels, (F,)."""
    pattern = np.full((*SHAPE, LINES), 6.0)
    for place, by in where.items():
        pattern[place] += by
    return pattern.ravel()


def made(
    where: dict[tuple[int, int], float],
    *,
    second: str = SECOND,
    scatter: float = 0.0,
    measured: float = 0.3,
    evidence: tuple[float, float] = (9.0, 8.6),
    view: OneByOne | Pooling | None = None,
) -> tuple[SimpleNamespace, SimpleNamespace]:
    """Setting and what was found of two effects that differ at some points and channels, eight draws each."""
    rng = np.random.default_rng(5)
    draws = np.concatenate([np.tile(differing(w), (8, 1)) for w in ({}, where)])
    draws = draws + scatter * rng.normal(size=draws.shape)
    groups = {FIRST: tuple(range(8)), second: tuple(range(8, 16))}
    library = Library(changes=draws, groups=groups, shares=np.linspace(0.0, 1.0, 16))
    data = tuple(SimpleNamespace(point=SimpleNamespace(speed_hz=hz, torque_ratio=1.0)) for hz in SPEEDS)
    changes = SimpleNamespace(observed=differing({}), measured=np.full(SIZE, measured))
    setting = SimpleNamespace(
        machine=preset("paper-lightly-damped"),
        data=data,
        channels=CHANNELS,
        simulated=("resonator1.y.acceleration", "resonator3.y.acceleration"),
        changes=changes,
        seed=3,
    )
    screen = SimpleNamespace(names=(FIRST, second), evidence=np.array(evidence))
    fitted = viewed(view)
    return setting, SimpleNamespace(known=SimpleNamespace(library=library), screen=screen, view=lambda _: fitted)


def asked(setting: SimpleNamespace, found: SimpleNamespace) -> NextExperiment:
    decision = Decision(word="ambiguous", chosen=tuple(found.screen.names), p=1e-5, reasons=("alike",))
    advice = _next(setting, found, decision, None)  # type: ignore[arg-type]
    assert advice is not None
    return advice


def test_what_no_recording_tells_apart_is_to_be_looked_at() -> None:
    """A broken and a pitted tooth of one gear stay a set at any score (`of_teeth`): no speed may be said to decide."""
    told = next_experiment(("missing_tooth@gear", "tooth_spall@gear", "tooth_crack@gear"), 112.0, 3, ("bearing1",))
    assert told is not None and told.separation_expected is None
    assert told.sentence.startswith("No recording tells these two apart") and "Open the gearbox" in told.sentence
    crack = next_experiment(("missing_tooth@gear", "tooth_crack@gear"), 2.0, 3, ("bearing1",))
    assert crack is not None and "Open the gearbox" not in crack.sentence
    apart = next_experiment(("missing_tooth@gear", "tooth_spall@pinion"), 2.0, 3, ("bearing1",))
    assert apart is not None and "Open the gearbox" not in apart.sentence


def test_beyond_the_known_effects_no_two_of_them_are_to_be_told_apart() -> None:
    decision = Decision(word="unknown_physics", chosen=("squeeze_film@bearing1", "rub@pinion"), p=1e-5, reasons=("?",))
    force = EstimatedForce(site="bearing1", samples={}, law=None)
    quick, full = (
        _next(None, None, decision, Unknown(force=force, tried=tried))  # type: ignore[arg-type]
        for tried in (False, True)
    )
    assert quick is not None and full is not None
    assert "full budget" in quick.sentence and "full budget" not in full.sentence
    assert all("near bearing1" in one.sentence and one.separation_now is None for one in (quick, full))
    assert _undecidable(decision, "", ()) == UNLISTED


@pytest.mark.parametrize("view", [one_by_one(), families()], ids=["lines", "families"])
@pytest.mark.parametrize("point", range(len(SPEEDS)))
def test_the_speed_at_which_two_effects_differ_is_advised(point: int, view: OneByOne | Pooling) -> None:
    setting, found = made({(point, 1): 9.0}, view=view)
    apart = apart_of(setting, found, found.screen.names)  # type: ignore[arg-type]
    assert apart is not None and apart.loudest == CHANNELS[1]
    others = np.delete(apart.by_point, point)
    assert others == pytest.approx(0.0, abs=1e-9) and apart.by_point[point] > ADDS
    told = asked(setting, found)
    assert f"about {SPEEDS[point]:g} Hz" in told.sentence and f"above all on {CHANNELS[1]}" in told.sentence
    assert told.separation_now == pytest.approx(0.4)
    assert told.separation_expected == pytest.approx(0.4 + apart.by_point[point])


def test_what_is_expected_is_half_the_squared_distance_over_the_overdispersion() -> None:
    setting, found = made({(0, 0): 9.0})
    here, there = (found.view("").place(found.known.library.changes[k]) for k in (0, 8))
    expected = float(np.sum((here - there) ** 2)) / (2.0 * SCALE)
    told = asked(setting, found)
    assert told.separation_expected == pytest.approx(0.4 + expected)


@pytest.mark.parametrize("scatter", [0.0, 1.5])
def test_nothing_tells_apart_what_has_the_same_pattern(scatter: float) -> None:
    """Draws of one effect lie as far apart as from the other's: that they do lie apart promises nothing."""
    setting, found = made({}, scatter=scatter, evidence=(9.0, 9.0))
    told = asked(setting, found)
    assert "would not tell" in told.sentence and "alike at every speed" in told.sentence
    assert told.separation_now == 0.0
    assert told.separation_expected == pytest.approx(0.0, abs=ADDS)


def test_where_all_speeds_tell_alike_one_more_is_worth_their_mean() -> None:
    setting, found = made({(p, c): 6.0 for p in range(SHAPE[0]) for c in range(SHAPE[1])})
    apart = apart_of(setting, found, found.screen.names)  # type: ignore[arg-type]
    assert apart is not None
    told = asked(setting, found)
    assert "one more speed" in told.sentence
    assert told.separation_expected == pytest.approx(0.4 + apart.by_point.mean())


def test_a_lead_of_the_second_counts_against_the_first() -> None:
    _, found = made({}, evidence=(8.0, 9.5))
    decision = Decision(word="ambiguous", chosen=(FIRST, SECOND), p=1e-5, reasons=())
    assert _lead(found, decision) == pytest.approx(-1.5)  # type: ignore[arg-type]
    assert _lead(found, replace(decision, chosen=(FIRST,))) == 0.0  # type: ignore[arg-type]


def test_of_a_sensor_where_none_was_simulated_nothing_is_promised() -> None:
    faint = asked(*made({(0, 0): 4.0, (1, 0): 4.0}, second=ELSEWHERE))
    assert "accelerometer" in faint.sentence and "bearing2" in faint.sentence and "not known" in faint.sentence
    assert f"{CHANNELS[0]} tells them apart best" in faint.sentence
    assert faint.separation_now == pytest.approx(0.4) and faint.separation_expected is None
    alike = asked(*made({}, second=ELSEWHERE))
    assert "look alike there" in alike.sentence and alike.separation_expected is None
    clear = asked(*made({(0, 0): 40.0}, second=ELSEWHERE))
    assert clear.sentence.startswith("A further recording at about 20 Hz") and "may tell more" in clear.sentence
    assert clear.separation_expected is not None and clear.separation_expected > DECIDES


def test_no_sensor_is_advised_where_all_bearings_of_a_shaft_have_one() -> None:
    machine = preset("paper-lightly-damped")
    pinion, mesh = machine.gears[0].name, machine.meshes[0].name
    left = unheard(machine, ("bearing1", "bearing3"))
    assert left[pinion] == ("bearing2",) and left[mesh] == ("bearing2", "bearing4") and "bearing2" not in left
    apart = Apart(told=np.zeros((1, 1)), points=("30 Hz",), channels=("a",), unheard=left)
    pair = (f"tooth_crack@{pinion}", "torque_ripple@input")
    one = next_experiment(pair, 0.1, 1, ("bearing1",), apart)
    assert one is not None and one.sentence.startswith("An accelerometer on the housing of bearing2 is most likely")
    every = replace(apart, unheard=unheard(machine, ("bearing1", "bearing2")))
    none = next_experiment(pair, 0.1, 1, ("bearing1", "bearing2"), every)
    assert none is not None and "accelerometer" not in none.sentence.lower() and "would not tell" in none.sentence


def test_longer_recordings_are_advised_only_where_noise_is_what_scatters() -> None:
    told = np.full((5, 1), 4.0)
    points = tuple(f"{hz} Hz" for hz in range(5))
    apart = Apart(told=told, points=points, channels=("a",), longer=3.9)
    assert best_look(apart).kind == "speed"
    assert best_look(replace(apart, longer=4.1)).kind == "longer"
    advice = next_experiment((FIRST, SECOND), 1.0, 5, ("bearing1",), replace(apart, longer=6.0))
    assert advice is not None and "twice as long" in advice.sentence and advice.separation_expected == 7.0
    quiet, loud = (made({(0, 0): 9.0}, measured=m) for m in (0.0, 3.0))
    gains = [apart_of(s, f, f.screen.names) for s, f in (quiet, loud)]  # type: ignore[arg-type]
    assert gains[0] is not None and gains[0].longer == 0.0
    assert gains[1] is not None and 0.0 < gains[1].longer <= gains[1].by_point.sum()


def test_an_effect_without_draws_predicts_nothing() -> None:
    setting, found = made({(0, 0): 9.0})
    assert apart_of(setting, found, (FIRST, "rub@gear")) is None  # type: ignore[arg-type]
    assert apart_of(setting, found, (FIRST,)) is None  # type: ignore[arg-type]


def test_the_distance_is_laid_out_over_points_and_channels() -> None:
    view = viewed()
    table = laid_out(view, differing({}), differing({(0, 0): 3.0, (2, 1): 6.0}), SHAPE)  # type: ignore[arg-type]
    whole = np.sum((view.place(differing({})) - view.place(differing({(0, 0): 3.0, (2, 1): 6.0}))) ** 2)
    assert table.sum() == pytest.approx(whole) and np.count_nonzero(table) == 2
    assert table[2, 1] > table[0, 0] > 0.0
    same = laid_out(view, differing({}), differing({}), SHAPE)  # type: ignore[arg-type]
    assert not same.any()
