"""How far the speed's wander lifts sidebands, by how near they stand to the teeth's line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.judge.measured import OWN_WANDER_DB, UNSTEADY_DB, unsteady_db, wander_db, wander_patterns
from reconcile.observe.statistics import Statistics
from reconcile.observe.watch import WatchList
from tests.reconcile.judge.toothed import HARMONICS, own, small

WATCH = WatchList(
    lines=tuple(replace(w, label=f"{w.orders['f_m1']:g}*f_m1") if w.family == "mesh" else w for w in small().lines),
    modulations=(),
)
"""With the labels that the teeth's lines have."""

MESH_HZ = 500.0
MEASURED = ((6.4, 7.3), (8.5, 4.6), (12.0, 3.3), (18.0, 1.2))
"""Hz beside the line, and dB by which the common level of sidebands differs between recordings of sound machines."""


def lines_hz(slow_hz: float, drive_hz: float = 40.0) -> np.ndarray:
    speeds = {"f_r1": drive_hz, "f_r2": slow_hz, "f_m1": MESH_HZ, "f_o1": 133.0}
    return np.array([sum(n * speeds[base] for base, n in line.orders.items()) for line in WATCH.lines])


@pytest.mark.parametrize(("hz", "db"), MEASURED)
def test_the_wander_is_what_recordings_of_sound_machines_differ_by(hz: float, db: float) -> None:
    found = wander_db(WATCH, lines_hz(hz))[own("f_r2", 1)]
    assert found.size == 2 * HARMONICS and np.ptp(found) < 1e-9
    assert abs(found[0] - db) < 1.0, "which 12 lines and 50 machines do not tell better"


def test_it_falls_with_the_distance_and_lifts_no_other_line() -> None:
    found = wander_db(WATCH, lines_hz(7.0))
    first, second, third = (found[own("f_r2", n)] for n in (1, 2, 3))
    assert (first > second).all() and (second > third).all() and (third > 0.0).all()
    assert not wander_db(WATCH, lines_hz(25.0))[own("f_r2", 1)].any()
    assert not found[own("f_r1", 1)].any(), "40 Hz from the line"
    assert not found[[k for k, w in enumerate(WATCH.lines) if w.family != "sideband"]].any()


def test_nearer_than_was_measured_it_grows_no_further() -> None:
    first = wander_db(WATCH, lines_hz(1.0))[own("f_r2", 1)]
    assert np.allclose(first, wander_db(WATCH, lines_hz(6.4))[own("f_r2", 1)]) and first[0] < 7.5


def test_each_shafts_sidebands_move_together_by_their_own_distance() -> None:
    hz, features = lines_hz(7.0, 9.0), len(WATCH.lines) + 5
    fast, slow, smear = wander_patterns(WATCH, hz, features)
    expected = wander_db(WATCH, hz)
    for pattern, shaft, other in ((fast, "f_r1", "f_r2"), (slow, "f_r2", "f_r1")):
        mine = np.concatenate([own(shaft, n) for n in (1, 2, 3)])
        assert np.array_equal(pattern[mine], expected[mine])
        assert not pattern[np.concatenate([own(other, n) for n in (1, 2, 3)])].any()
        assert not pattern[len(WATCH.lines) :].any() and not smear[mine].any()


def test_one_sideband_differs_from_the_others_by_no_more_than_before() -> None:
    hz = lines_hz(6.4)
    sizes = {"line": hz.size, "floor": 4, "total": 4, "kurtosis": 2, "skewness": 2, "phase": 0}
    shapes = {name: np.zeros((1, n)) for name, n in sizes.items()} | {"depth": np.zeros((1, 2, 1))}
    given = Statistics(**shapes, turn=np.zeros((1, 2, 1)), band=np.zeros((1, 2)), **rest())  # type: ignore[arg-type]
    found = unsteady_db(given, WATCH, hz)[: hz.size]
    assert np.allclose(found[own("f_r2", 1)], OWN_WANDER_DB)
    assert np.allclose(found[own("f_r1", 1)], UNSTEADY_DB["line"])
    third = wander_db(WATCH, hz)[own("f_r2", 3)]
    assert np.allclose(found[own("f_r2", 3)], np.maximum(third, UNSTEADY_DB["line"]))


def rest() -> dict[str, object]:
    used = {"line", "floor", "total", "kurtosis", "skewness", "phase", "depth", "turn", "band"}
    return {name: 0.0 for name in Statistics.__dataclass_fields__ if name not in used}
