"""Does the machine change while it is recorded? Stiffness, damping or gain that comes and goes, or drifts.

A stiffness that varies by d(t) leaves what the linear model answers to -d(t) x. For all frequencies of d at once that
is held against the error: the error's back projection times the motion, transformed (a periodogram of the variation).
Its null distribution comes from errors with the same spectrum and random phases, put through the same search.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from scipy import fft

from reconcile.driven.channels import FloatArray
from reconcile.driven.missing import displaced, sensitivities
from reconcile.driven.model import Model, Run, answer_to, counted

RESAMPLES, ALPHA = 199, 0.01
REFINED = 1.2
"""By which the share may grow between the frequencies that are tried, which errors without a cause are held to."""
SLOWEST, FASTEST = 0.75, 2.5
"""Turns of a variation over the stretch, at least, and its frequency over the natural one, at most."""
A_TURN, ALIKE = 1.5, 0.8
"""Turns under which a wave is no other than a drift that explains as much of what it does."""
KINDS = ("stiffness", "damping", "force_gain")


@dataclass(frozen=True, kw_only=True)
class Varying:
    """What varies, how fast (0 Hz: it drifts), by how much of itself, and its share of the error's power."""

    kind: str
    hz: float
    size: float
    """Amplitude, or change from the first to the last sample, over the mean."""
    share: float
    p_value: float


@dataclass(frozen=True, kw_only=True)
class Search:
    """A stretch made ready: causes per unit of each kind, (n,), the transfer to the motion, and what retuning does."""

    model: Model
    run: Run
    causes: tuple[FloatArray, ...]
    held: FloatArray

    def through(self, cause: FloatArray) -> FloatArray:
        """Motion that a force per unit mass makes, where it counts."""
        found = answer_to(self.model, cause, self.run.data.step_s, self.run.data.order)
        return counted(found[self.run.skip :], self.run)

    def free(self, columns: FloatArray) -> FloatArray:
        """Columns without what retuning explains."""
        return np.asarray(columns - self.held @ (self.held.T @ columns))


def _ready(model: Model, run: Run) -> Search:
    x = run.data.answer - model.output_offset if run.data.order == 0 else displaced(model, run)
    v = np.gradient(x, run.data.step_s)
    held, sizes, _ = np.linalg.svd(_unit(sensitivities(model, run, displaced(model, run))), full_matrices=False)
    causes = (-model.stiffness * x, -model.damping * v, model.gain * (run.data.drive - run.data.drive.mean()))
    return Search(model=model, run=run, causes=causes, held=np.asarray(held[:, sizes > 1e-9 * sizes[0]]))


def _unit(columns: FloatArray) -> FloatArray:
    size = np.linalg.norm(columns, axis=0)
    return np.asarray(columns / np.where(size > 0, size, 1.0))


class _Scan:
    """Share of an error that a variation of one kind explains, at every frequency."""

    def __init__(self, found: Search, cause: FloatArray) -> None:
        run, model = found.run, found.model
        n = cause.size
        self.size, self.skip, self.cause = 2 * n, run.skip, cause
        omega = 2.0 * np.pi * np.fft.rfftfreq(self.size, run.data.step_s)
        below = model.stiffness - omega**2 + 1j * omega * model.damping
        self.back = np.conj((1j * omega) ** run.data.order / below)
        gain = np.abs(np.concatenate([self.back, self.back[-2:0:-1]])) ** 2
        power = np.abs(np.fft.fft(cause, self.size)) ** 2
        mixed = np.fft.ifft(np.fft.fft(gain) * np.fft.fft(power)).real / self.size
        lines = np.fft.rfftfreq(self.size, run.data.step_s)
        own = math.sqrt(model.stiffness) / (2.0 * math.pi)
        self.tried = (lines > SLOWEST / (n * run.data.step_s)) & (lines < FASTEST * own)
        self.hz = lines[self.tried]
        self.norm = mixed[: lines.size][self.tried]

    def shares(self, error: FloatArray) -> FloatArray:
        """(frequencies,)."""
        padded = np.concatenate([np.zeros(self.skip), error])
        back = fft.irfft(fft.rfft(padded, self.size) * self.back, self.size)[: self.cause.size]
        met = np.abs(fft.rfft(back * self.cause, self.size)[self.tried]) ** 2
        return np.asarray(2.0 * met / np.maximum(self.norm * float(error @ error), 1e-300))


def _share(found: Search, cause: FloatArray, shapes: FloatArray, error: FloatArray) -> tuple[float, FloatArray]:
    """Share of an error, free of retuning, that a cause times shapes (n, k) explains, and their sizes (k,)."""
    columns = found.free(np.column_stack([found.through(cause * shape) for shape in shapes.T]))
    size = np.linalg.norm(columns, axis=0)
    sizes = np.asarray(np.linalg.lstsq(columns / size, error, rcond=None)[0] / size)
    left = error - columns @ sizes
    return 1.0 - float(left @ left) / max(float(error @ error), 1e-300), sizes


def _span(found: Search, cause: FloatArray, shapes: FloatArray) -> FloatArray:
    """Orthonormal columns of what a cause times shapes (n, k) does, free of retuning."""
    columns = found.free(np.column_stack([found.through(cause * shape) for shape in shapes.T]))
    return np.asarray(np.linalg.qr(_unit(columns))[0])


def _by_chance(found: Search, scans: Sequence[_Scan], drifts: Sequence[FloatArray], error: FloatArray) -> float:
    """Share that the same search explains of an error without a cause."""
    best = max(scans, key=lambda scan: float(scan.shares(error).max()))
    hz = float(best.hz[np.argmax(best.shares(error))])
    wave = _wave(hz, best.cause.size, found.run.data.step_s)
    spans = [*drifts, _span(found, best.cause, wave)]
    return max(float(np.sum((span.T @ error) ** 2)) for span in spans) / max(float(error @ error), 1e-300)


def _wave(hz: float, n: int, step_s: float) -> FloatArray:
    t = np.arange(n) * step_s
    return np.column_stack([np.cos(2.0 * math.pi * hz * t), np.sin(2.0 * math.pi * hz * t)])


def _periodic(found: Search, scan: _Scan, error: FloatArray) -> tuple[float, float, FloatArray]:
    """Share, frequency in Hz, and sizes of the best wave."""
    n, step = scan.cause.size, found.run.data.step_s
    hz, spacing = float(scan.hz[np.argmax(scan.shares(error))]), float(scan.hz[1] - scan.hz[0])

    def left(at: float) -> float:
        return -_share(found, scan.cause, _wave(at, n, step), error)[0]

    ends = (max(hz - spacing, SLOWEST / (n * step)), hz + spacing)
    near = scipy.optimize.minimize_scalar(left, bounds=ends, method="bounded")
    share, sizes = _share(found, scan.cause, _wave(float(near.x), n, step), error)
    return share, float(near.x), sizes


def varying(model: Model, run: Run, error: FloatArray, rng: np.random.Generator) -> Varying:
    """The variation that explains most of an error (n - skip,)."""
    found = _ready(model, run)
    error = found.free(error)
    n = run.data.answer.size
    slow = np.column_stack([np.linspace(-0.5, 0.5, n), np.linspace(-1.0, 1.0, n) ** 2])
    scans = [_Scan(found, cause) for cause in found.causes]
    best: list[tuple[float, float, FloatArray, int]] = []
    for k, (scan, cause) in enumerate(zip(scans, found.causes, strict=True)):
        share, sizes = _share(found, cause, slow, error)
        best.append((share, 0.0, sizes, k))
        best.append((*_periodic(found, scan, error), k))
    share, hz, sizes, kind = max(best, key=lambda b: b[0])
    if hz * n * run.data.step_s < A_TURN:
        drifts = [b for b in best if b[1] == 0.0 and b[0] > ALIKE * share]
        share, hz, sizes, kind = max(drifts, key=lambda b: b[0], default=(share, hz, sizes, kind))
    null = []
    lines = np.abs(fft.rfft(error))
    slow_spans = [_span(found, cause, slow) for cause in found.causes]
    for _ in range(RESAMPLES):
        drawn = fft.irfft(lines * np.exp(2j * np.pi * rng.uniform(size=lines.size)), error.size)
        null.append(_by_chance(found, scans, slow_spans, found.free(drawn)))
    size = abs(float(sizes[0])) if hz == 0.0 else math.hypot(*(float(s) for s in sizes))
    p = (1 + sum(value >= share / REFINED for value in null)) / (RESAMPLES + 1)
    return Varying(kind=KINDS[kind], hz=hz, size=size, share=share, p_value=p)
