"""A small watch list of teeth with sidebands of two shafts, and changes of its features."""

from __future__ import annotations

import numpy as np

from reconcile.judge.metric import Whitening
from reconcile.observe.watch import Watched, WatchList
from signals.series import FloatArray

HARMONICS, POINTS, CHANNELS, OTHERS = 6, 3, 2, 4
SIGMA_DB = 3.0
GROUPS = tuple((shaft, turns) for shaft in ("f_r1", "f_r2") for turns in (1, 2, 3))
SHAPE = (POINTS, CHANNELS)
SPEEDS = ((0,), (1,), (2,))
"""Numbers of the operating points of each."""


def _line(orders: dict[str, float], family: str) -> Watched:
    return Watched(label=str(orders), orders=orders, family=family, slips=False)


def small() -> WatchList:
    """Shafts and teeth first, then sidebands, harmonic by harmonic, a race at the end."""
    lines = [_line({"f_r1": 1.0}, "shaft"), *(_line({"f_m1": k}, "mesh") for k in range(1, HARMONICS + 1))]
    for k in range(1, HARMONICS + 1):
        lines += [_line({"f_m1": k, s: side * n}, "sideband") for s, n in GROUPS for side in (-1, 1)]
    return WatchList(lines=(*lines, _line({"f_o1": 1.0}, "outer")), modulations=())


WATCH = small()
FEATURES = len(WATCH.lines) + OTHERS
"""Of a channel: lines, then what else there is."""
WHITEN = Whitening(sigma=np.full(POINTS * CHANNELS * FEATURES, SIGMA_DB))


def own(shaft: str, turns: int) -> np.ndarray:
    """Numbers of the lines of a group."""
    return np.array(
        [k for k, w in enumerate(WATCH.lines) if w.family == "sideband" and abs(w.orders.get(shaft, 0)) == turns]
    )


def raised(shaft: str, turns: int, rise_db: float, points: tuple[int, ...] = (0, 1, 2)) -> FloatArray:
    """Change (P * C * F,) of one group at some operating points, on every channel."""
    cube = np.zeros((*SHAPE, FEATURES))
    for point in points:
        cube[point][:, own(shaft, turns)] = rise_db
    return cube.ravel()


def sound(n: int = 400, sigma_db: float = SIGMA_DB) -> FloatArray:
    """Changes of sound machines, each feature by itself, (n, P * C * F)."""
    return np.random.default_rng(5).normal(0.0, sigma_db, (n, POINTS * CHANNELS * FEATURES))
