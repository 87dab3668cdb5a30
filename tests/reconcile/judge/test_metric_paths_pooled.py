"""The space of comparison: what scatters counts little, paths follow sizes, families pool."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.judge.metric import LEAST_DB, fit_metric, neighbour_scatter, whitening
from reconcile.judge.paths import build_paths
from reconcile.judge.pooled import DEAD, Pooling, lines_beside, own_lines, pooling
from reconcile.observe.features import Layout
from reconcile.observe.watch import WatchList, watch_list
from sim.presets import preset


def test_a_straight_path_has_no_scatter() -> None:
    shares = np.random.default_rng(0).uniform(size=9)
    points = np.outer(shares, [3.0, -2.0, 0.5]) + np.array([1.0, 2.0, 3.0])
    assert np.abs(neighbour_scatter(points, shares)).max() < 1e-6
    assert neighbour_scatter(points[:2], shares[:2]).shape == (0, 3)


def test_scatter_is_that_of_one_draw() -> None:
    rng = np.random.default_rng(1)
    shares = np.sort(rng.uniform(size=4000))
    points = np.outer(shares, [10.0, 0.0]) + rng.normal(0.0, [0.5, 2.0], (4000, 2))
    np.testing.assert_allclose(neighbour_scatter(points, shares).std(axis=0), [0.5, 2.0], rtol=0.05)


def test_the_metric_tells_classes_apart_where_plain_distance_does_not() -> None:
    """Two effects differ by 1 along a quiet axis and scatter by 30 along a loud one; few draws are there."""
    rng = np.random.default_rng(2)
    spread, centres = np.array([30.0, 0.25]), np.array([[0.0, 0.0], [0.0, 1.0]])
    drawn = [c + rng.normal(size=(30, 2)) * spread for c in centres]
    metric = fit_metric(np.zeros(2), [d - d.mean(axis=0) for d in drawn])
    tests = np.concatenate([c + rng.normal(size=(200, 2)) * spread for c in centres])
    truth = np.repeat([0, 1], 200)

    def right(place) -> float:  # type: ignore[no-untyped-def]
        library, seen = np.concatenate([place(d) for d in drawn]), place(tests)
        nearest = np.argmin(np.sum((seen[:, None] - library[None]) ** 2, axis=2), axis=1)
        return float(np.mean((nearest >= 30) == truth))

    assert right(metric) > right(lambda x: x) + 0.15
    assert right(metric) > 0.85


def test_whitening_counts_what_is_known_everywhere() -> None:
    observed, measured = np.array([1.0, np.nan, 3.0, 4.0]), np.array([3.0, 1.0, 1.0, np.nan])
    null = np.random.default_rng(3).normal(0.0, 4.0, (4000, 4))
    drawn = np.zeros((100, 4))
    drawn[:10, 2] = np.nan
    whiten = whitening(observed, measured, null, drawn)
    assert np.isinf(whiten.sigma).tolist() == [False, True, True, True]
    assert whiten.sigma[0] == pytest.approx(np.sqrt(9 + 16 + LEAST_DB**2), rel=0.03)
    np.testing.assert_array_equal(whiten(np.array([1.0, 9.0, np.nan, 9.0]))[1:], 0.0)


def test_paths_run_from_half_the_smallest_draw_over_draws_and_middles() -> None:
    points = np.array([[4.0, 0.0], [2.0, 0.0], [0.0, 6.0]])
    paths = build_paths(points, {"a@x": (0, 1), "b@x": (2,)}, np.array([0.9, 0.1, 0.5]))
    np.testing.assert_allclose(paths.points, [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0], [0.0, 3.0], [0.0, 6.0]])
    assert paths.owner.tolist() == [0, 0, 0, 0, 1, 1]
    assert paths.low.tolist() == [-1, 1, 1, 0, -1, 2]
    assert paths.high.tolist() == [1, 1, 0, 0, 2, 2]
    best, which = paths.nearest(paths.distances(np.array([3.1, 0.1])))
    assert which.tolist() == [2, 4] and best[0] == pytest.approx(0.02)


def test_pooling_keeps_noise_small_and_sees_a_rise_of_a_family() -> None:
    pool = Pooling(family=np.repeat([0, 1], 16), names=("a", "b"), points=2, channels=1)
    rng = np.random.default_rng(4)
    noise = rng.normal(size=(500, 64))
    resting = pool(noise)
    assert resting.shape == (500, 6)
    noise[:, :16] += 1.5
    noise[:, 32:48] += 1.5
    risen = pool(noise)
    rise = [(risen[:, k].mean() - resting[:, k].mean()) / resting[:, k].std() for k in range(6)]
    assert rise[0] > 3.0 and abs(rise[3]) < 0.3
    np.testing.assert_array_equal(pool(np.full((1, 64), DEAD))[0, [1, 2, 4, 5]], 0.0)
    np.testing.assert_allclose(pool(-noise)[:, [0, 3]], -risen[:, [0, 3]])


def layout_of(watched: WatchList) -> Layout:
    sizes = {"lines": len(watched.lines), "modulations": len(watched.modulations), "phases": len(watched.phased)}
    return Layout(bands=25, shapes=4, shafts=2, **sizes)


def test_phases_of_one_sensor_or_without_a_baseline_have_no_family() -> None:
    watched = watch_list(preset("paper-lightly-damped"))
    layout = layout_of(watched)
    found = pooling(watched, layout, points=1, channels=1)
    unused = np.flatnonzero(found.family < 0)
    np.testing.assert_array_equal(unused, range(*layout.slices()["phase"].indices(layout.size)))
    changes = np.zeros((1, layout.size))
    changes[0, unused] = 50.0
    np.testing.assert_array_equal(found(changes), 0.0)


def test_single_lines_are_levels_and_phases_of_the_same_lines() -> None:
    watched = watch_list(preset("paper-lightly-damped"))
    layout, sizes = layout_of(watched), {"points": 1, "channels": 2}
    for view in (own_lines, lines_beside):
        levels, both = (view(watched, layout, phased=phased, **sizes).chosen for phased in (False, True))
        named = [watched.lines[i].label for i in watched.phased]
        phases = {label for label, one in zip(named, both[layout.slices()["phase"]], strict=True) if one}
        assert phases == {w.label for w, one in zip(watched.lines, levels, strict=False) if one}
        assert both.sum() == 2 * levels.sum()


def test_lines_of_machines_without_teeth_are_not_taken_to_repeat() -> None:
    for name, repeats in (("paper-lightly-damped", True), ("rotor", False)):
        watched = watch_list(preset(name))
        views = [view(watched, layout_of(watched), points=1, channels=1) for view in (own_lines, lines_beside)]
        assert [view.repeats for view in views] == [repeats] * 2


def test_first_sidebands_are_the_pairs_next_to_the_mesh_harmonics() -> None:
    watched = watch_list(preset("paper-lightly-damped"))
    layout = layout_of(watched)
    chosen = lines_beside(watched, layout, points=1, channels=1).chosen
    labels = {line.label for line, one in zip(watched.lines, chosen, strict=False) if one}
    assert labels == {f"{k}*f_m{sign}1*f_r{shaft}" for k in range(1, 7) for sign in "+-" for shaft in (1, 2)}
    assert not chosen[layout.lines :].any()


def test_every_feature_of_a_machine_has_a_family() -> None:
    watched = watch_list(preset("paper-lightly-damped"))
    layout = layout_of(watched)
    found = pooling(watched, layout, points=1, channels=2, phased=True)
    assert found.family.size == layout.size
    assert set(found.family) == set(range(len(found.names)))
    assert {n for n in found.names if n.startswith("phase")} == {
        "phase mesh", "phase sidebands f_r1", "phase sidebands f_r2"
    }  # fmt: skip
    first = dict(zip([w.label for w in watched.lines], found.family, strict=False))
    assert first["1*f_o1"] == first["8*f_o1"] != first["1*f_o3"]
    assert first["1*f_m-1*f_r1"] == first["2*f_m+1*f_r1"] != first["1*f_m-1*f_r2"]
    assert first["1*f_m-2*f_r1"] == first["5*f_m+3*f_r1"] != first["1*f_m-1*f_r1"] != first["5*f_m+1*f_r1"]
    assert first["1*f_m"] == first["2*f_m"] != first["3*f_m"]
    assert first["0.5*f_r1"] != first["1*f_r1"] != first["2*f_r1"]
