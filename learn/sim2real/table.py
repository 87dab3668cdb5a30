"""The training table: features of simulated recordings, whole and cut into short pieces, by several processes."""

from __future__ import annotations

from collections.abc import Container, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from itertools import compress
from pathlib import Path

import numpy as np

from learn import features, geometries, unknown, whole
from learn.assess import ANYWHERE, WHOLE
from learn.bank import bank
from learn.dataset import Row, rows_of
from learn.looked import stretches
from learn.model import Head, Model
from learn.sim2real.pools import AtOnce, pool_of
from learn.train import fit_head
from sideband_datasets.recipe.bearings import CLASSES
from signals.series import FloatArray

WINDOW_TURNS = 10.0
WINDOWS = 2
PARTS = 8
"""Shares of the machines that processes take in turn."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """`known`, `unknown` (pieces, features); `long`, `anywhere` (recordings, features); labels and machines of both.

    `tried` (recordings, geometries, features): those of `long` as if each geometry were the bearing's.
    """

    known: FloatArray
    unknown: FloatArray
    labels: tuple[str, ...]
    machines: tuple[int, ...]
    long: FloatArray
    anywhere: FloatArray
    tried: FloatArray
    long_labels: tuple[str, ...]
    long_machines: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Example:
    """Features of one simulated recording: of its pieces, and of the whole."""

    label: str
    machine: int
    known: list[FloatArray]
    unknown: list[FloatArray]
    long: FloatArray
    anywhere: FloatArray
    """(parts, features) both."""
    tried: FloatArray
    """(parts, geometries, features)."""


def pieces(row: Row) -> list[FloatArray]:
    """Two windows of ten turns at places the machine's number decides, then the recording in stretches."""
    rng = np.random.default_rng(row.machine)
    short = int(WINDOW_TURNS * row.rate_hz / row.speed_hz)
    starts = rng.integers(0, max(1, row.samples.size - short), WINDOWS)
    whole_ones = [part[0] for part in stretches([row.samples], row.rate_hz, row.speed_hz)]
    return [*(row.samples[s : s + short] for s in starts), *whole_ones]


def part_table(part: int, folders: Sequence[Path]) -> list[Example]:
    """Features of one share of the machines."""
    found = []
    for row in rows_of(folders, part, PARTS):
        spectra = [bank([piece], row.rate_hz, row.speed_hz) for piece in pieces(row)]
        parts = stretches([row.samples], row.rate_hz, row.speed_hz, whole.TURNS)
        longer = [bank(one, row.rate_hz, row.speed_hz) for one in parts]
        found.append(
            Example(
                label=row.label,
                machine=row.machine,
                known=[features.vector(one, row.orders)[0] for one in spectra],
                unknown=[unknown.vector(one)[0] for one in spectra],
                long=np.stack([whole.vector(one, row.orders)[0] for one in longer]),
                anywhere=np.stack([unknown.vector(one)[0] for one in longer]),
                tried=np.stack([geometries.rows(one) for one in longer]),
            )
        )
    return found


def table(folders: Sequence[Path], processes: int = 2) -> Table:
    """Features of datasets read together; the same whatever the number of processes."""
    with pool_of(processes) as pool:
        return tabled(begun(folders, pool or AtOnce()))


def begun(folders: Sequence[Path], pool: Executor) -> list[Future[list[Example]]]:
    """The shares of a table, each a piece of work of a pool."""
    return [pool.submit(part_table, part, folders) for part in range(PARTS)]


def tabled(shares: Sequence[Future[list[Example]]]) -> Table:
    """A table from all its shares, waited for."""
    return joined([one for share in shares for one in share.result()])


def joined(found: Sequence[Example]) -> Table:
    """All examples as one table."""
    return Table(
        known=np.stack([row for one in found for row in one.known]),
        unknown=np.stack([row for one in found for row in one.unknown]),
        labels=tuple(one.label for one in found for _ in one.known),
        machines=tuple(one.machine for one in found for _ in one.known),
        long=np.concatenate([one.long for one in found]),
        anywhere=np.concatenate([one.anywhere for one in found]),
        tried=np.concatenate([one.tried for one in found]),
        long_labels=tuple(one.label for one in found for _ in one.long),
        long_machines=tuple(one.machine for one in found for _ in one.long),
    )


def some(found: Table, machines: int, among: Container[int] | None = None) -> Table:
    """The rows of about so many machines, evenly picked of those `among` the given ones (none: all); at least one."""
    names = sorted(k for k in set(found.machines) if among is None or k in among)
    chosen = names[:: max(1, round(len(names) / max(machines, 1)))]
    short, long = np.isin(found.machines, chosen), np.isin(found.long_machines, chosen)
    return Table(
        known=found.known[short],
        unknown=found.unknown[short],
        labels=tuple(compress(found.labels, short)),
        machines=tuple(compress(found.machines, short)),
        long=found.long[long],
        anywhere=found.anywhere[long],
        tried=found.tried[long],
        long_labels=tuple(compress(found.long_labels, long)),
        long_machines=tuple(compress(found.long_machines, long)),
    )


def train(found: Table, *, seed: int, made_by: dict[str, object]) -> Model:
    """All heads: of pieces and of whole recordings, each with the geometry known and unknown."""
    heads = {
        name: fit_head(values, found.labels, found.machines, names, CLASSES, seed=seed)
        for name, values, names in (
            ("known", found.known, features.NAMES),
            ("unknown", found.unknown, unknown.NAMES),
        )
    }
    heads[WHOLE] = _of_whole(found, found.long, whole.NAMES, seed)
    likelier = np.stack([geometries.log_ratios(one, heads[WHOLE]) for one in found.tried])
    heads[ANYWHERE] = _of_whole(found, np.hstack([likelier, found.anywhere]), geometries.NAMES, seed)
    return Model(heads=heads, made_by=made_by)


def _of_whole(found: Table, values: FloatArray, names: tuple[str, ...], seed: int) -> Head:
    """A softmax regression on recordings."""
    labels, machines = found.long_labels, found.long_machines
    return fit_head(values, labels, machines, names, CLASSES, seed=seed, networks=1, hidden=())
