"""The training table: features of simulated recordings, whole and cut into short pieces, by several processes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context

import numpy as np

from learn import features, unknown
from learn.bank import bank
from learn.model import Model
from learn.simulate.machines import CLASSES
from learn.simulate.rows import Row, Variant, rows
from learn.train import fit_head
from signals.series import FloatArray

WINDOW_TURNS = 10.0
MIDDLE_TURNS = (15.0, 40.0)
WINDOWS = 2
Piece = tuple[FloatArray, FloatArray, str, int, bool]
PARTS = 8
"""Shares of the machines that processes take in turn."""


@dataclass(frozen=True, kw_only=True)
class Table:
    """`known` (rows, features), `unknown` (rows, features), labels and machines by row."""

    known: FloatArray
    unknown: FloatArray
    labels: tuple[str, ...]
    machines: tuple[int, ...]
    whole: tuple[bool, ...]


def pieces(row: Row) -> list[FloatArray]:
    """The recording, two windows of ten turns and one of medium length, at places the machine's number decides."""
    rng = np.random.default_rng(row.machine)
    short = int(WINDOW_TURNS * row.rate_hz / row.speed_hz)
    starts = rng.integers(0, max(1, row.samples.size - short), WINDOWS)
    medium = int(rng.uniform(*MIDDLE_TURNS) * row.rate_hz / row.speed_hz)
    return [row.samples, *(row.samples[s : s + short] for s in starts), row.samples[:medium]]


def part_table(
    part: int, count: int, seed: int, variant: Variant
) -> list[tuple[FloatArray, FloatArray, str, int, bool]]:
    """Features of one share of the machines."""
    found = []
    for row in rows(count, seed, part, PARTS, variant):
        for place, piece in enumerate(pieces(row)):
            spectra = bank([piece], row.rate_hz, row.speed_hz)
            known, _ = features.vector(spectra, row.orders)
            plain, _ = unknown.vector(spectra)
            found.append((known, plain, row.label, row.machine, place == 0))
    return found


def pool_of(processes: int) -> AbstractContextManager[Executor | None]:
    """Processes of one thread each, as another thread costs more than it brings; none for one."""
    if processes == 1:
        return nullcontext()
    for library in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(library, "1")
    return ProcessPoolExecutor(processes, mp_context=get_context("spawn"))


def table(count: int, seed: int, variant: Variant, processes: int = 2, parts: Sequence[int] = range(PARTS)) -> Table:
    """Features of a dataset of about `count` machines; the same whatever the number of processes."""
    work = partial(part_table, count=count, seed=seed, variant=variant)
    with pool_of(processes) as pool:
        shares = list(pool.map(work, parts) if pool is not None else map(work, parts))
    flat = [one for share in shares for one in share]
    return Table(
        known=np.stack([one[0] for one in flat]),
        unknown=np.stack([one[1] for one in flat]),
        labels=tuple(one[2] for one in flat),
        machines=tuple(one[3] for one in flat),
        whole=tuple(one[4] for one in flat),
    )


def train(found: Table, *, seed: int, made_by: dict[str, object]) -> Model:
    """Both heads."""
    heads = {
        name: fit_head(values, found.labels, found.machines, names, CLASSES, seed=seed)
        for name, values, names in (
            ("known", found.known, features.NAMES),
            ("unknown", found.unknown, unknown.NAMES),
        )
    }
    return Model(heads=heads, made_by=made_by)
