"""Bearings with the same lines: the one whose defect, added to the baseline, is heard as the test is."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import fft

from reconcile.atlas.plan import AtlasPlan, Draw, Point, with_tooth_pairs
from reconcile.atlas.run import run_members
from reconcile.calibrate.chain import band_centres_hz
from reconcile.calibrate.uncertain import Offsets
from reconcile.judge.screen import Screen
from reconcile.machine import injected, refine
from reconcile.machine.ground import Ground
from reconcile.machine.injected import MOST, PER, SIZES_DB, apart, counted, twins
from reconcile.machine.meter import Meter
from reconcile.observe.impact_bands import Rate, Standing, density, standing
from reconcile.observe.steady import Steady
from sim.core.response import Response
from sim.core.spec import TermSpec
from sim.presets import preset

NAMES = ("outer_spall@bearing3", "outer_spall@bearing4", "inner_spall@bearing3", "unbalance@gear")
RATE_HZ, COUNT = 20480.0, 20480
PASSES = Rate(hz=78.0, spacing_hz=30.0, sidebands=0)


def screen(direct: tuple[float, ...], evidence: tuple[float, ...] = (27.2, 27.6, 3.0, 5.0)) -> Screen:
    log = np.array(evidence) - max(evidence)
    return Screen(
        names=NAMES,
        evidence=np.array(evidence),
        direct=np.array(direct),
        weights=np.exp(log) / np.exp(log).sum(),
        by=np.zeros(4, dtype=int),
        p_any=0.5,
        strongest=2.0,
        p_best=1e-3,
        p_direct=1e-6,
        misfit=0.5,
        length=10.0,
    )


def told_twins(direct: tuple[float, ...]) -> list[tuple[str, ...]]:
    return twins(SimpleNamespace(screen=screen(direct)), preset("paper"))  # type: ignore[arg-type]


def test_places_that_share_lines_are_rivals() -> None:
    assert told_twins((25.0, 25.0, -20.0, 0.0)) == [NAMES[1::-1]]


@pytest.mark.parametrize("direct", [(25.0, 12.0, 0.0, 0.0), (4.9, 4.9, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)])
def test_no_rivals_where_impacts_tell_or_are_not_sure(direct: tuple[float, ...]) -> None:
    assert told_twins(direct) == []


def test_bearings_with_other_lines_are_none() -> None:
    names = ("outer_spall@bearing1", "outer_spall@bearing4")  # on shafts of other speeds
    seen = replace(screen((25.0, 25.0, 0.0, 0.0)), names=(*names, *NAMES[2:]))
    assert twins(SimpleNamespace(screen=seen), preset("paper")) == []  # type: ignore[arg-type]


def test_what_is_heard_counts_against_the_place_farther_off() -> None:
    before = screen((25.0, 25.0, -20.0, 0.0))
    after = counted(before, {NAMES[0]: 11.4, NAMES[1]: 9.4})
    assert after.evidence - before.evidence == pytest.approx([-2.0 * PER, 0.0, 0.0, 0.0])
    assert after.located - before.direct == pytest.approx([-2.0 * PER, 0.0, 0.0, 0.0])
    assert np.array_equal(after.direct, before.direct), "whether there are impacts is another question"
    assert after.weights.sum() == pytest.approx(1.0) and after.weights[1] > 0.95 > before.weights[1]
    assert after.patterns == pytest.approx(before.evidence - before.direct), "the levels say what they said"
    assert after.heard == pytest.approx({NAMES[0]: 2.0 * PER, NAMES[1]: 0.0})
    far = counted(before, {NAMES[0]: 90.0, NAMES[1]: 9.4})
    assert before.evidence[0] - far.evidence[0] == pytest.approx(MOST)


def test_the_distance_is_bounded_and_small_below_the_noise() -> None:
    quiet = Standing(level=np.zeros((2, 3)), error=np.ones((2, 3)), hz=78.0)
    assert apart(quiet, np.zeros((2, 3))) == 0.0
    assert apart(quiet, np.full((2, 3), 60.0)) == pytest.approx(6 * 9.0)
    loud = Standing(level=np.full((2, 3), 20.0), error=np.ones((2, 3)), hz=78.0)
    assert apart(loud, np.full((2, 3), 22.0)) < apart(quiet, np.full((2, 3), 2.0)), "paths are known to some decibels"


def blows(seed: int, *sizes: tuple[float, float]) -> np.ndarray:
    """Per channel, (carrier in Hz, size): motion without noise, (C, n)."""
    rng = np.random.default_rng(seed)
    since = (np.arange(COUNT) / RATE_HZ + rng.uniform(0, 0.01)) % (1.0 / PASSES.hz)
    return np.array([size * np.exp(-since / 1e-3) * np.sin(2 * np.pi * hz * since) for hz, size in sizes])


def base(test: np.ndarray, baseline: np.ndarray) -> injected.Base:
    hz = np.fft.rfftfreq(COUNT, 1 / RATE_HZ)
    over = np.array([1 / np.sqrt(np.interp(hz, *density(row, RATE_HZ))) for row in baseline])
    heard, white = (np.array([fft.rfft(x) * o for x, o in zip(rows, over, strict=True)]) for rows in (test, baseline))
    ground = Ground(white=white, factor=over, count=COUNT, rate_hz=RATE_HZ)
    seen, alone = (standing(ground.bands(rows), ground.seconds, PASSES) for rows in (heard, white))
    return injected.Base(ground=ground, heard=heard, test=seen, alone=alone)


@pytest.mark.slow
@pytest.mark.parametrize("louder", [0.3, 1.0, 3.0])
def test_the_place_whose_sensor_rings_high_is_told_from_the_one_next_to_it_at_any_size(louder: float) -> None:
    own, through = ((1200.0, 4.0), (4500.0, 4.0)), ((1200.0, 4.0), (1200.0, 2.0))
    rng = np.random.default_rng(3)
    before, noise = rng.normal(size=(2, COUNT)), rng.normal(size=(2, COUNT))
    for struck, other in ((own, through), (through, own)):
        at = base(noise + blows(7, *struck), before)
        near, heard = injected._off(at, louder * blows(8, *struck), PASSES)
        far, _ = injected._off(at, louder * blows(8, *other), PASSES)
        assert near.shape == SIZES_DB.shape and heard and at.out and near.min() < far.min() - 5.0


def test_what_adds_nothing_is_no_place() -> None:
    rng = np.random.default_rng(3)
    at = base(rng.normal(size=(1, COUNT)), rng.normal(size=(1, COUNT)))
    assert not at.out, "nothing is heard in the test"
    squared, heard = injected._off(at, None, PASSES)
    assert np.all(np.isinf(squared)) and not heard
    assert not injected._off(at, 1e-6 * blows(8, (1200.0, 4.0)), PASSES)[1], "nobody would hear it"
    assert injected._off(at, blows(8, (1200.0, 4.0)), PASSES)[1]


def test_of_draws_that_nobody_hears_none_is_the_nearest() -> None:
    near = injected._Off(squared=np.array([[1.0, 2.0], [8.0, 6.0]]), heard=np.array([False, True]))
    far = injected._Off(squared=np.array([[1.0, 2.0], [4.0, 8.0]]), heard=np.array([False, False]))
    assert injected._nearest([near, far]) == pytest.approx(3.0)
    assert injected._nearest([far]) == np.inf


SITES, SENSORS = ("bearing3", "bearing4"), tuple(f"bearing{k}.outer.y.acceleration" for k in (1, 2, 3))


def pit(site: str, width_m: float) -> TermSpec:
    load = -np.pi / 2 + 0.35  # where the teeth press the gear's shaft
    return TermSpec(term="outer_spall", site=site, parameters={"width": width_m, "depth": 5e-5, "angle": load})


def recorded(plan: AtlasPlan, term: TermSpec | None, seed: int) -> Steady:
    """One second of the machine with white noise 20 dB below, as sensors hear it."""
    (response,) = run_members([plan.member(Draw(pair=0, term=term), Point(speed_hz=30.0))], SENSORS)
    assert isinstance(response, Response)
    clean = np.asarray(response.signals[:, -COUNT:])
    noise = np.random.default_rng(seed).normal(size=clean.shape) * 0.1 * clean.std(axis=1, keepdims=True)
    return Steady(samples=clean + noise, rate_hz=RATE_HZ, speed_hz=30.0, estimate=None)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("visible", "widths"),
    [
        ((False, True, True, False), ([2e-3], [3e-3])),
        ((False, True, False, False), ([2e-3], [2e-3])),
        ((False, False, False, False), ([1e-3, 2e-3], [3e-3, 4e-3])),
    ],
)
def test_draws_that_show_something_speak_for_a_place_if_need_be_those_of_another(
    visible: tuple[bool, ...], widths: tuple[list[float], ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    names = [f"outer_spall@{site}" for site in SITES]
    terms = [pit(site, 1e-3 * (1 + k)) for k, site in enumerate(np.repeat(SITES, 2))]
    groups = {names[0]: (0, 1), names[1]: (2, 3)}
    known = SimpleNamespace(library=SimpleNamespace(groups=groups), terms=terms)
    found = SimpleNamespace(fitted=SimpleNamespace(visible=np.array(visible)), known=known)
    for module in (refine, injected):
        monkeypatch.setattr(module, "best_draws", lambda _f, _k, n, *_, **__: [terms[k] for k in groups[n]])
    told = injected.leaders(found, names, np.zeros(1))  # type: ignore[arg-type]
    assert tuple([t.parameters["width"] for t in place] for place in told) == widths
    assert [{t.site for t in place} for place in told] == [{site} for site in SITES]


@pytest.mark.parametrize(
    ("evidence", "skipped"),
    [
        ((60.0, 49.0, 3.0, 5.0), True),
        ((60.0, 49.1, 3.0, 5.0), False),
        ((60.0, 30.0, 3.0, 60.1), False),
        ((60.0, 49.0, 3.0, 55.0), False),
    ],
)
def test_nothing_is_simulated_where_hearing_could_open_nothing(
    evidence: tuple[float, ...], skipped: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is worth `MOST` against a place; what leads all else by that and a name's lead keeps its place, and stays the
    best effect. A part that strikes beside the best effect is asked."""
    asked: list[object] = []
    monkeypatch.setattr(injected, "distances", lambda _s, _f, names, _m: asked.append(names) or {})
    point = SimpleNamespace(baseline="there", spectra=(SimpleNamespace(rate_hz=25600.0),) * 2)
    setting = SimpleNamespace(machine=preset("paper"), data=(point,))
    found = SimpleNamespace(screen=screen((25.0, 25.0, 0.0, 0.0), evidence))
    after = injected.placed_by_hearing(setting, found, Meter(map))  # type: ignore[arg-type]
    assert after is found.screen and (asked == []) is skipped


@pytest.mark.slow
@pytest.mark.parametrize("struck", SITES)
def test_a_bearing_without_a_sensor_is_told_from_the_next_one_with_it(
    struck: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    rest = tuple(Offsets(values=np.zeros(0)) for _ in range(2))
    machine = with_tooth_pairs(preset("paper"))
    plan = AtlasPlan(machine=machine, numbers=(), offsets=rest, twins=rest, draws=(), seed=3)
    point = SimpleNamespace(
        point=Point(speed_hz=30.0),
        baseline="there",
        spectra=(recorded(plan, pit(struck, 1.2e-3), 1), recorded(plan, None, 2)),
    )
    gain = SimpleNamespace(chain=SimpleNamespace(gain_db=np.zeros((3, band_centres_hz().size))))
    setting = SimpleNamespace(
        machine=machine, plan=plan, data=(point,), simulated=SENSORS, seen_through=(gain,), seed=1,
        changes=SimpleNamespace(observed=np.zeros(1)),
    )  # fmt: skip
    monkeypatch.setattr(injected, "LEADERS", 2)
    monkeypatch.setattr(injected, "DRAWS", 2)
    monkeypatch.setattr(
        injected, "leaders", lambda _f, names, _o: [[pit(n.split("@")[1], w) for w in (8e-4, 2e-3)] for n in names]
    )
    names = [f"outer_spall@{site}" for site in SITES]
    found = SimpleNamespace(screen=screen((25.0, 25.0, 0.0, 0.0)), fitted=None, known=None, views=(), led={})
    off = injected.distances(setting, found, names, Meter(map))  # type: ignore[arg-type]
    other = next(s for s in SITES if s != struck)
    assert off[f"outer_spall@{other}"] > off[f"outer_spall@{struck}"] + 2.0
    monkeypatch.setattr(injected, "distances", lambda *_: off)
    monkeypatch.setattr(injected, "of_best", lambda one, *_: one)
    after = injected.placed_by_hearing(setting, found, Meter(map))  # type: ignore[arg-type]
    assert after.names[int(np.argmax(after.evidence))] == f"outer_spall@{struck}" and after.weights.max() > 0.9
    unbased = SimpleNamespace(**{**vars(setting), "data": (SimpleNamespace(**{**vars(point), "baseline": None}),)})
    assert injected.placed_by_hearing(unbased, found, Meter(map)) is found.screen  # type: ignore[arg-type]
