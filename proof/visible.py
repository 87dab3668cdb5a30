"""How much of a hidden effect is there to be seen at all: against the drift between baseline and test, and the noise.

Made with everything hidden known, so no engine can do this: the test is simulated again without its effects, and once
more without the drift. What differs is measured in decibels over the narrow bins that stand above the sensors' noise.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from proof.case import quiet_parts, quiet_tests
from proof.each import of_each
from proof.machine import FloatArray
from proof.plan import Case

STANDS_OUT = 4.0
"""Power over the noise's from which a bin counts."""
NEW_DB = 6.0
"""A bin is new where the effect lifts it so far over what was there, noise included."""


@dataclass(frozen=True, kw_only=True)
class Visible:
    """`effect_db`, `drift_db`: root mean square change of the bins above the noise, by the effects and by the drift
    alone. `new_share`: share of all bins that the effects lift by 6 dB over signal and noise. `parts_db`: of several
    effects, what each changes beside the others."""

    effect_db: float
    drift_db: float
    new_share: float
    parts_db: tuple[float, ...] = ()


def visibility(case: Case) -> Visible:
    """Over all sensors and operating points of a case with effects."""
    effect, drift, new = [], [], []
    for with_effects, without, undrifted, noise in quiet_tests(case):
        for x, y, z, level in zip(with_effects, without, undrifted, noise, strict=True):
            a, b, c = (_bins(row) for row in (x, y, z))
            n = level**2 * _window_power(x.size)
            effect.append(_change_db(a, b, n))
            drift.append(_change_db(b, c, n))
            new.append(10.0 * np.log10((a + n) / (b + n)) > NEW_DB)
    return Visible(
        effect_db=_rms(np.concatenate(effect)),
        drift_db=_rms(np.concatenate(drift)),
        new_share=float(np.mean(np.concatenate(new))),
        parts_db=_parts(case) if len(case.effects) > 1 else (),
    )


def _parts(case: Case) -> tuple[float, ...]:
    """Of each effect: how far it moves what the others show."""
    moved: list[list[FloatArray]] = [[] for _ in case.effects]
    for every, fewer, noise in quiet_parts(case):
        for own, without in zip(moved, fewer, strict=True):
            for x, y, level in zip(every, without, noise, strict=True):
                own.append(_change_db(_bins(x), _bins(y), level**2 * _window_power(x.size)))
    return tuple(_rms(np.concatenate(own)) for own in moved)


def _bins(samples: FloatArray) -> FloatArray:
    window = np.hanning(samples.size)
    return np.asarray(np.abs(np.fft.rfft((samples - samples.mean()) * window)) ** 2)


def _window_power(size: int) -> float:
    """White noise of unit variance has this expected power in a bin."""
    return float(np.sum(np.hanning(size) ** 2))


def _change_db(now: FloatArray, before: FloatArray, noise: float) -> FloatArray:
    """Of the bins that stand above the noise in either, dB."""
    seen = np.maximum(now, before) > STANDS_OUT * noise
    return np.asarray(10.0 * np.log10((now[seen] + noise) / (before[seen] + noise)))


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def measure(cases: Sequence[Case], store: Path, jobs: int) -> dict[str, Visible]:
    """Of all cases with effects; what is stored is not made again."""
    found = stored(store)
    todo = [c for c in cases if c.effects and not _measured(c, found.get(c.name))]
    return of_each(todo, visibility, found, store, jobs)


def _measured(case: Case, one: Visible | None) -> bool:
    return one is not None and (len(case.effects) == 1 or len(one.parts_db) == len(case.effects))


def stored(store: Path) -> dict[str, Visible]:
    """By case; empty where nothing is stored."""
    if not store.exists():
        return {}
    document: Mapping[str, Mapping[str, Any]] = json.loads(store.read_text(encoding="utf-8"))
    return {name: _read(values) for name, values in document.items()}


def _read(values: Mapping[str, Any]) -> Visible:
    return Visible(**{**values, "parts_db": tuple(values.get("parts_db", ()))})


def told(one: Visible | None) -> str:
    """For the list of failures."""
    if one is None:
        return ""
    new = f"{one.new_share:.1%} of the bins new"
    each = f" ({', '.join(f'{part:.1f}' for part in one.parts_db)} by each beside the other)" if one.parts_db else ""
    return f"; spectrum moved {one.effect_db:.1f} dB by it{each}, {one.drift_db:.1f} dB by drift alone, {new}"
