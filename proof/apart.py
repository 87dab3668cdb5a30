"""What could be told apart at all: which fault of a tooth it is, a bound from above.

All of them take stiffness from one tooth for as long as it is in mesh, and differ in how that goes along its path. Here
everything but that is known: the concealed machine, which does not drift, the path of every sensor, the angle of its
gear at every moment, which tooth it is, and what each of the faults does. The turns of the gear are averaged (all that
comes back with it is in there), and only the sensors' noise stands between the fault that is hidden and another one of
the size that comes nearest. Two such Gaussians of one spread and a distance d apart are told with Phi(d / 2) right
answers (R. O. Duda, P. E. Hart, D. G. Stork, Pattern Classification, 2nd ed., 2001, section 2.6), and no method can do
better that does not know how likely each fault is, or how large it tends to be.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import uniform_filter1d
from scipy.stats import norm

from proof.case import MACHINE, another_test, instruments_of, with_noise
from proof.each import of_each
from proof.machine import FloatArray, hidden_machine
from proof.model.layout import G
from proof.oracle import NOISES
from proof.plan import Case, Hiding

ComplexArray = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]

TOOTH = ("root_crack", "broken_tooth", "flank_pit")
"""Laws of one tooth."""
FIRST_PIT = 0.6
"""Size of a pit that is tried first: the share of the width. The sizes of the others are the share of stiffness."""
FIRST_LOSS = 0.1
"""The same of the others, where a pit is hidden."""
NEAR = 1.5
"""Factor within which a fault is scaled as it is; beyond, it is simulated again at the scaled size."""
LARGEST = 0.95
USED = 0.9
"""Of the orders up to half the samples of a turn: those that the sensors' filters pass."""
AROUND = 41
"""Orders over which the noise's variance is taken as one."""
SURE = 0.95
FAR = 2.0 * float(norm.isf(1.0 - SURE))
"""Distance from which on so many answers can be right."""


@dataclass(frozen=True, kw_only=True)
class Apart:
    """Distances in deviations of the noise: `seen` from a sound tooth, `rivals` by law and variant (`broken_tooth 0`)
    from that fault at the size that comes nearest."""

    seen: float
    rivals: Mapping[str, float]

    @property
    def least(self) -> float:
        """From the nearest."""
        return min(self.rivals.values())

    @property
    def nearest(self) -> str:
        """Its law."""
        return min(self.rivals, key=lambda name: self.rivals[name]).split()[0]


def of_a_tooth(case: Case) -> bool:
    """Whether one fault of a tooth is all that is hidden."""
    return len(case.effects) == 1 and case.effects[0].law in TOOTH


def apart(case: Case) -> Apart:
    """Of a case that hides one fault of a tooth."""
    hidden = case.effects[0]
    ear = _Ear.of(case)
    told = ear.heard(hidden)
    found = {}
    for rival in rivals(hidden):
        other = ear.heard(rival)
        scale = _scale(told, other)
        if not 1.0 / NEAR < scale < NEAR:
            other = ear.heard(replace(rival, value=min(max(rival.value * scale, 1e-3), LARGEST)))
            scale = _scale(told, other)
        found[f"{rival.law} {rival.variant}"] = _size(told - scale * other)
    return Apart(seen=_size(told), rivals=found)


def rivals(hidden: Hiding) -> Iterator[Hiding]:
    """The faults of other laws at the same tooth, in all their variants, at the size that is tried first."""
    for law in TOOTH:
        if law == hidden.law:
            continue
        size = FIRST_LOSS if hidden.law == "flank_pit" else hidden.value
        other = replace(hidden, law=law, value=FIRST_PIT if law == "flank_pit" else size)
        for variant in range(other.about().variants):
            yield replace(other, variant=variant)


@dataclass(frozen=True, kw_only=True)
class _Ear:
    """Hears what a fault adds to the mean turn of its gear, over the noise of that."""

    case: Case
    ways: Sequence[object]
    sound: Sequence[ComplexArray]
    noise: Sequence[FloatArray]
    ratio: float

    @classmethod
    def of(cls, case: Case) -> _Ear:
        base, (ways, noises) = hidden_machine(case.rng(MACHINE)), instruments_of(case)
        machine = case.nominal.sound(base, case.torque_nm)
        gear = case.effects[0].about().sites.index(case.effects[0].site)
        ratio = float(machine.g[G.Z1] / machine.g[G.Z1 + gear])
        sound = another_test(case, 1, base, (), ways)
        silent = [np.vstack([one[:1], np.zeros_like(one[1:])]) for one in sound]
        draws = [[mean_turn(o, ratio) for o in with_noise(case, silent, noises, 1, k)] for k in range(NOISES)]
        noise = [np.mean(np.abs(drawn) ** 2, axis=0) for drawn in zip(*draws, strict=True)]
        smooth = [uniform_filter1d(power, AROUND, axis=1, mode="nearest") for power in noise]
        return cls(case=case, ways=ways, sound=[mean_turn(o, ratio) for o in sound], noise=smooth, ratio=ratio)

    def heard(self, fault: Hiding) -> ComplexArray:
        """Over the noise's deviation, all speeds, channels and orders one after the other."""
        base = hidden_machine(self.case.rng(MACHINE))
        test = another_test(self.case, 1, base, (fault,), self.ways)  # type: ignore[arg-type]
        rows = []
        for one, sound, noise in zip(test, self.sound, self.noise, strict=True):
            used = slice(1, int(USED * sound.shape[1]))
            rows.append(((mean_turn(one, self.ratio) - sound)[:, used] / np.sqrt(0.5 * noise[:, used])).ravel())
        return np.concatenate(rows)


def mean_turn(heard: FloatArray, ratio: float) -> ComplexArray:
    """Spectra (channels, orders) of the mean turn of a gear that turns `ratio` times as fast as the drive shaft, of
    signals (channels, n) below that shaft's angle, rad."""
    turns = heard[0] * ratio / (2.0 * np.pi)
    span = float(turns[-1] - turns[0])
    per_turn = int(turns.size / span) // 2 * 2
    count = int(span)
    at = turns[0] + np.arange(count * per_turn) / per_turn
    mean = [CubicSpline(turns, row)(at).reshape(count, per_turn).mean(axis=0) for row in heard[1:]]
    return np.asarray(np.fft.rfft(mean, axis=1) / per_turn, dtype=np.complex128)


def _scale(told: ComplexArray, other: ComplexArray) -> float:
    """Factor on `other` that comes nearest, not below zero."""
    both = float(np.vdot(other, told).real)
    return max(both / max(float(np.vdot(other, other).real), 1e-300), 0.0)


def _size(white: ComplexArray) -> float:
    return float(np.sqrt(np.vdot(white, white).real))


def measure(cases: Sequence[Case], store: Path, jobs: int) -> dict[str, Apart]:
    """Of all cases of one fault of a tooth; what is stored is not made again."""
    found = stored(store)
    todo = [c for c in cases if of_a_tooth(c) and c.name not in found]
    return of_each(todo, apart, found, store, jobs)


def store_of(results: Path, split: str) -> Path:
    """Where a split's are kept."""
    return results / f"apart-{split}.json"


def stored(store: Path) -> dict[str, Apart]:
    """By case; empty where nothing is stored."""
    if not store.exists():
        return {}
    return {name: Apart(**values) for name, values in json.loads(store.read_text(encoding="utf-8")).items()}
