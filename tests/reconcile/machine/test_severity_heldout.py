"""Sizes are covered by their intervals; gains are near one for the right effect and near none for a wrong one."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.candidates import size_parameter, size_range
from reconcile.judge.paths import build_paths
from reconcile.judge.space import Library
from reconcile.machine.heldout import LATER, held_out, spectral_mask, splits
from reconcile.machine.library import Catalogued, joined
from reconcile.machine.severity import LEAST_SPREAD, estimated_severity, evened
from reconcile.observe.features import SOFT, Layout
from reconcile.observe.statistics import third_octaves
from sim.core.spec import TermSpec
from sim.terms import REGISTRY

BANDS = third_octaves().size - 1
LAYOUT = Layout(lines=40, bands=BANDS, shapes=4, modulations=6)
STANDING = 15
NAME, WRONG = "outer_spall@bearing1", "outer_spall@bearing3"


def catalogue(shares: np.ndarray, changes: np.ndarray, names: tuple[str, ...]) -> Catalogued:
    """`shares` (n,) for each name; `changes` (names * n, F)."""
    term = REGISTRY.get("outer_spall")
    assert term is not None
    low, high = size_range(size_parameter(term))
    terms, groups = [], {}
    for c, name in enumerate(names):
        groups[name] = tuple(range(c * shares.size, (c + 1) * shares.size))
        site = name.split("@")[1]
        sizes = low * (high / low) ** shares
        terms += [TermSpec(term="outer_spall", site=site, parameters={"width": float(s)}) for s in sizes]
    library = Library(changes=changes, groups=groups, shares=np.tile(shares, len(names)))
    return Catalogued(library=library, terms=tuple(terms))


def test_intervals_of_the_size_cover_it() -> None:
    term = REGISTRY.get("outer_spall")
    assert term is not None
    low, high = size_range(size_parameter(term))
    rng = np.random.default_rng(0)
    shares = (np.arange(16) + 0.5) / 16
    away, covered, trials = [], 0, 60
    for _ in range(trials):
        along = np.stack([6 * shares, 3 * shares**2, 0 * shares], axis=1)
        points = along + rng.normal(0.0, 0.3, along.shape)
        known = catalogue(shares, points, (NAME,))
        true = float(rng.uniform(0.15, 0.9))
        seen = np.array([6 * true, 3 * true**2, 0.0]) + rng.normal(0.0, 0.3, 3)
        fitted = SimpleNamespace(
            paths=build_paths(points, known.library.groups, shares), place=lambda x: x, overdispersion=0.2
        )
        found = estimated_severity(fitted, known, NAME, seen)  # type: ignore[arg-type]
        size = low * (high / low) ** true
        assert found.low < found.value < found.high and found.unit == "m" and found.name == "width"
        covered += found.low <= size <= found.high
        away.append(abs(np.log(found.value / size)))
    assert covered >= 0.8 * trials
    assert np.median(away) < 0.35


def test_draws_that_crowd_count_once_for_the_scale_they_stand_for() -> None:
    few = np.exp(np.array([0.0, 3.0, 6.0]))
    crowded = np.concatenate([few[:1].repeat(8), few[1:]])
    assert evened(few, np.full(3, 1 / 3)) == pytest.approx(np.full(3, 1 / 3), rel=1e-9)
    told = evened(crowded, np.full(10, 0.1))
    assert told.sum() == pytest.approx(1.0) and told[:8].sum() == pytest.approx(1 / 3, rel=1e-9)
    near = np.exp(np.array([0.0, LEAST_SPREAD, 6.0]))
    assert evened(near, np.array([0.5, 0.25, 0.25]))[:2].sum() == pytest.approx(
        0.75 / (1 + np.exp(-0.5)) / (0.75 / (1 + np.exp(-0.5)) + 0.25)
    )


def test_a_size_does_not_lean_to_where_most_was_simulated() -> None:
    rng = np.random.default_rng(1)
    even = (np.arange(16) + 0.5) / 16
    crowd = np.sort(np.concatenate([even, rng.uniform(0.65, 0.75, 24)]))
    values = []
    for shares in (even, crowd):
        points = np.stack([0.2 * shares, 0 * shares, 0 * shares], axis=1)
        known = catalogue(shares, points, (NAME,))
        paths = build_paths(points, known.library.groups, shares)
        fitted = SimpleNamespace(paths=paths, place=lambda x: x, overdispersion=0.2)
        values.append(estimated_severity(fitted, known, NAME, np.array([0.1, 0.0, 0.0])).value)  # type: ignore[arg-type]
    assert abs(np.log(values[1] / values[0])) < 0.25, "nothing tells the size: as before"


def spectral(points: int) -> np.ndarray:
    """Mask of a machine whose first lines stand 20 dB above their noise and whose others are buried."""
    level = np.zeros((1, LAYOUT.size))
    level[0, :STANDING] = 20.0
    scale = SimpleNamespace(line_noise=np.full((1, LAYOUT.lines), 1.0 / SOFT))
    lens = SimpleNamespace(scale=scale, nominal=level)
    return spectral_mask(LAYOUT, [lens] * points)  # type: ignore[list-item]


def data(points: int, perfect: bool) -> tuple[SimpleNamespace, Catalogued, np.ndarray]:
    """Changes of `points` points where the named effect moves a third of the lines by 12 dB; the rival others."""
    rng = np.random.default_rng(points)
    size = LAYOUT.size * points
    pattern, rival = (np.where(rng.uniform(size=size) < 0.3, 12.0, 0.0) for _ in range(2))
    shares = (np.arange(8) + 0.5) / 8
    grown = 0.3 + 0.7 * shares[:, None]
    changes = np.concatenate([grown * pattern, grown * (rival if perfect else rng.permutation(pattern))])
    seen = 0.8 * pattern + rng.normal(0.0, 0.3, size)
    names = (NAME, WRONG)
    known = catalogue(shares, changes, names)
    halves = np.stack([seen, 0.8 * pattern + rng.normal(0.0, 0.3, size)])
    made = SimpleNamespace(
        observed=seen,
        halves=halves,
        measured=np.full(size, 0.5),
        null=rng.normal(0.0, 1.0, (24, size)),
        starts=tuple(LAYOUT.size * k for k in range(points + 1)),
    )
    return made, known, np.geomspace(30.0, 8000.0, size)


@pytest.mark.parametrize("points", [1, 3])
def test_the_right_effect_explains_held_out_data_and_nothing_else_does(points: int) -> None:
    made, known, frequency = data(points, perfect=True)
    how = {"spectral": spectral(points), "frequency": frequency, "seed": 0}
    right = held_out(made, known, NAME, **how)  # type: ignore[arg-type]
    assert right.gain > 0.9 and right.gain_low <= right.gain <= right.gain_high
    assert right.gain_low > 0.8
    for rival in (right.retuned, right.black_box, right.placebo):
        assert rival is not None and rival < 0.4
    assert right.numbers is not None and right.numbers >= len(REGISTRY.get("outer_spall").params)  # type: ignore[union-attr]
    assert [(p.term, p.site, p.draws) for p in right.placebos] == [("outer_spall", "bearing3", 8)]
    assert right.placebos[0].gain == right.placebo
    stays = np.sqrt(0.5**2 + 1.0)  # noise and drift of the made-up machines, dB
    assert right.ceiling == pytest.approx(1 - stays / right.before, abs=0.02)
    wrong = held_out(made, known, WRONG, **how)  # type: ignore[arg-type]
    assert wrong.gain < 0.3 and wrong.before == pytest.approx(right.before)
    assert wrong.placebo == pytest.approx(right.gain)


def test_each_point_is_held_out_once_and_a_single_ones_later_half() -> None:
    made, _, _ = data(3, perfect=True)
    mask = spectral(3)
    assert mask.sum() == 3 * (STANDING + BANDS)
    ways, _ = splits(made, mask)  # type: ignore[arg-type]
    assert not any(np.any(w.fit & w.score) for w in ways)
    np.testing.assert_array_equal(np.sum([w.score for w in ways], axis=0), mask)
    one, _, _ = data(1, perfect=True)
    (way,), told = splits(one, spectral(1))  # type: ignore[arg-type]
    assert told == LATER
    np.testing.assert_array_equal(way.scored, one.halves[1])
    np.testing.assert_array_equal(way.fitted, one.halves[0])


def test_libraries_join_under_their_names() -> None:
    shares = np.array([0.2, 0.8])
    one = catalogue(shares, np.zeros((4, 3)), (NAME, WRONG))
    two = catalogue(shares, np.ones((2, 3)), (WRONG,))
    both = joined(one, two)
    assert both.library.groups == {NAME: (0, 1), WRONG: (2, 3, 4, 5)}
    assert len(both.terms) == both.library.changes.shape[0] == both.library.shares.size == 6
    assert all(both.terms[k].site == "bearing3" for k in both.library.groups[WRONG])
