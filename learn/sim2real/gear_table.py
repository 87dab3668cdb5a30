"""The gears' training table: features of simulated recordings of gear pairs, whole and cut; the heads fitted to it."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass

import numpy as np

from learn.gears import features
from learn.gears.assess import CLASSES, LONG, SHORT, look
from learn.model import Head
from learn.sim2real.pools import AtOnce, pool_of
from learn.sim2real.table import PARTS, WINDOW_TURNS
from learn.simulate.gear_rows import GearRow, gear_rows
from learn.train import fit_head
from signals.series import FloatArray

WINDOWS = 2


@dataclass(frozen=True, kw_only=True)
class GearExample:
    """Features of one simulated recording: of its windows (windows, features), of the whole (features,)."""

    label: str
    fault: str
    machine: int
    short: FloatArray
    long: FloatArray
    clear_db: float
    found: bool
    """Whether the gear whose peak stands out most is the damaged one."""


def windows_of(row: GearRow) -> list[FloatArray]:
    """Two windows of ten turns of the driving gear at places that the machine's number decides, (c, n) each."""
    rng = np.random.default_rng(row.machine)
    short = int(WINDOW_TURNS * row.rate_hz / row.speed_hz)
    starts = rng.integers(0, max(1, row.channels.shape[1] - short), WINDOWS)
    return [row.channels[:, s : s + short] for s in starts]


def gear_examples(part: int, count: int, seed: int) -> list[GearExample]:
    """Features of one share of the machines."""
    found = []
    for row in gear_rows(count, seed, part, PARTS):
        cut, which = [], 0
        for channels in (*windows_of(row), row.channels):
            values, which = features.vector(look(list(channels), row.rate_hz, row.speed_hz, row.teeth))
            cut.append(values)
        found.append(
            GearExample(
                label=row.label,
                fault=row.fault,
                machine=row.machine,
                short=np.stack(cut[:-1]),
                long=cut[-1],
                clear_db=row.clear_db,
                found=which == row.place,
            )
        )
    return found


def gear_table(count: int, seed: int, processes: int = 2) -> list[GearExample]:
    """Features of about `count` machines; the same whatever the number of processes."""
    with pool_of(processes) as pool:
        return gears_of(begun(count, seed, pool or AtOnce()))


def begun(count: int, seed: int, pool: Executor) -> list[Future[list[GearExample]]]:
    """The shares of a gears' table, each a piece of work of a pool."""
    return [pool.submit(gear_examples, part, count, seed) for part in range(PARTS)]


def gears_of(shares: Sequence[Future[list[GearExample]]]) -> list[GearExample]:
    """A gears' table from all its shares, waited for."""
    return [one for share in shares for one in share.result()]


def gear_heads(found: list[GearExample], seed: int) -> dict[str, Head]:
    """Both heads: for windows, and for whole recordings."""
    short = [(row, one) for one in found for row in one.short]
    return {
        name: fit_head(
            np.stack([row for row, _ in rows]),
            [one.label for _, one in rows],
            [one.machine for _, one in rows],
            features.NAMES,
            CLASSES,
            seed=seed,
            networks=1,
            hidden=(),
        )
        for name, rows in ((SHORT, short), (LONG, [(one.long, one) for one in found]))
    }
