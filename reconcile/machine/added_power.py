"""What the sensors of a reconciliation tell about a force at a support, ready for `reconcile.machine.force`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.plan import Point, at_point
from reconcile.calibrate.chain import (
    FARTHEST_DB,
    PRIOR_DB,
    SMOOTH_OCTAVES,
    STANDS_OUT,
    Healthy,
    floor_at,
    leading,
)
from reconcile.calibrate.uncertain import moved
from reconcile.judge.changes import Lens
from reconcile.machine.force import PER_DB, Heard
from reconcile.machine.local import MOST_DB, UNKNOWN_DB
from reconcile.machine.setting import Setting
from reconcile.observe.extract import HANN_NOISE_BINS, hann_spectrum, line_powers
from reconcile.observe.features import SOFT
from reconcile.observe.observation import PointData
from reconcile.observe.slack import slack
from reconcile.observe.statistics import LOBE, LOBE_SCATTER, Statistics
from reconcile.observe.steady import Steady
from reconcile.observe.watch import watch_list
from signals.series import FloatArray
from sim.assembly.assemble import assemble
from sim.assembly.receptance import receptances
from sim.core.errors import SidebandError
from sim.core.spec import MachineSpec

MACHINES = 12
"""Machines that agree with the baseline over which a response is averaged: 4 ms each to assemble."""
AXES = ("x", "y")
SHARES_DB = np.arange(-60.0, 61.0, 6.0)
"""Of the power along the second axis over that along the first, beside all along one."""
UNEVEN = 0.5
"""Share by which a floor that rose may be another under a line than beside it."""
HEARS = 0.1
"""Share of a channel's response that an axis must make for the force along it to count."""
LEAST_TOLD = 0.1
"""Weight of the lines that tell the gain, a line at the frequency itself being 1, from which on it is calibrated."""
CUT_OFF = 1e-2
"""Share of the support's own response below which a channel is cut off from it: what it hears came on other ways.
Without it the sums of twelve simulated gearboxes came up to twenty times too large, by lines of 2 to 4 kHz on the other
shaft; with 0.001 up to 3.8 times (95 %), with this 2.4."""


@dataclass(frozen=True, kw_only=True)
class Reached:
    """Lines of one operating point, `hz` (L,), as its channels hear a force at a support; `along` (axes, L): whether
    any of them tells it along that axis."""

    hz: FloatArray
    heard: Heard
    along: np.ndarray

    @property
    def axes(self) -> tuple[str, ...]:
        """Those along which any line is told."""
        return tuple(axis for axis, told in zip(AXES, self.along, strict=True) if told.any())


def ways() -> FloatArray:
    """(W, axes): shares of the axes in the mean square of a force, from all along the first to all along the second."""
    second = np.concatenate([[0.0], 1.0 / (1.0 + 10.0 ** (-SHARES_DB / 10.0)), [1.0]])
    return np.stack([1.0 - second, second], axis=1)


def machines_like(setting: Setting) -> tuple[MachineSpec, ...]:
    """Machines that may be the one recorded."""
    plan = setting.plan
    return tuple(moved(plan.machine, plan.numbers, one) for one in plan.offsets[:MACHINES])


def reached(
    setting: Setting,
    number: int,
    site: str,
    machines: Sequence[MachineSpec],
    healthy: Sequence[Healthy],
    *,
    beside_hz: Sequence[float] = (),
    told_by: Sequence[bool] | None = None,
) -> Reached | None:
    """The watched lines of an operating point and those at `beside_hz`, Hz at the point's own speed; None without a
    baseline, or where no machine can be assembled. `told_by`: channels that are asked, all where it is None."""
    one, lens = setting.data[number], setting.seen_through[number]
    before, after = one.spectra[1], one.spectra[0]
    if one.baseline is None or before is None:
        return None
    hz = np.concatenate([one.lines_hz, np.asarray(beside_hz, dtype=np.float64)])
    powers = _powers_by_newton(setting, one.point, site, machines, hz)
    if powers is None:
        return None
    error = gain_errors_db(setting, healthy, hz)
    asked = np.ones(len(setting.channels), dtype=bool) if told_by is None else np.asarray(told_by)
    response, spread, along = by_ways(powers, np.isfinite(error) & asked[:, None])
    gain = lens.chain.line_gain(hz)
    sides = [
        _line_over_noise(setting, one, *known, hz, beside_hz) for known in ((one.test, after), (one.baseline, before))
    ]
    heard = Heard(
        test=sides[0].line,
        before=sides[1].line,
        deviation=_deviation(setting, number, *sides),
        response=gain * response,
        spread_db=np.hypot(spread, np.nan_to_num(error)),
    )
    return Reached(hz=hz, heard=heard, along=along)


@dataclass(frozen=True, kw_only=True)
class _Side:
    """Of the test or the baseline, (C, L): power of lines less the noise, noise in the noise bandwidth of a line, and
    how far the noise under a line may be off, both as powers."""

    line: FloatArray
    noise: FloatArray
    scatter: FloatArray


def _line_over_noise(
    setting: Setting, one: PointData, seen: Statistics, steady: Steady, hz: FloatArray, beside_hz: Sequence[float]
) -> _Side:
    """Less the recording's own floor beside each line: of a line that slips the strongest lobe in reach is taken, which
    of noise alone is more than one lobe has."""
    lines = np.concatenate([seen.line, _powers(steady, one.point.speed_hz, beside_hz)], axis=1)
    noise = floor_at(seen, hz) * seen.resolution_hz
    reach = np.zeros(hz.size)
    watched = watch_list(setting.machine).lines
    reach[: one.lines_hz.size] = slack(watched, one.lines_hz) * one.lines_hz
    places = 1.0 + reach * HANN_NOISE_BINS / seen.resolution_hz
    under = LOBE + LOBE_SCATTER * np.sqrt(2.0 * np.log(places))
    return _Side(line=np.maximum(lines - under * noise, 0.0), noise=noise, scatter=LOBE_SCATTER * noise)


def _noise(one: PointData, lens: Lens, hz: FloatArray) -> FloatArray:
    """Noise power in the noise bandwidth of a line, (C, L), of the baseline's chain."""
    return np.asarray(lens.chain.line_noise(hz) * one.test.resolution_hz)


def _powers(steady: Steady, stated_hz: float, hz: Sequence[float]) -> FloatArray:
    """Of lines at `hz` where the drive shaft turns at `stated_hz`, read at the speed it turned with."""
    lines = np.asarray(hz, dtype=np.float64) * steady.speed_hz / stated_hz
    _, power, bin_hz = hann_spectrum(steady.samples, steady.rate_hz)
    return line_powers(power, bin_hz, lines, np.zeros(lines.size), 0.5 * steady.rate_hz)


def _powers_by_newton(
    setting: Setting, point: Point, site: str, machines: Sequence[MachineSpec], hz: FloatArray
) -> FloatArray | None:
    """(M, C + axes, L, axes): mean square acceleration by 1 N rms on each axis of the support's outer ring, of the
    channels and of the ring itself."""
    forces = [f"{site}.outer.{axis}" for axis in AXES]
    ends = [*(name.rpartition(".")[0] for name in setting.simulated), *forces]
    found = []
    for machine in machines:
        try:
            h = receptances(assemble(at_point(machine, point)), hz, forces=forces, motions=ends)
        except (SidebandError, ValueError, np.linalg.LinAlgError):
            continue
        power = (h.real**2 + h.imag**2) * (2.0 * np.pi * hz[:, None, None]) ** 4
        found.append(np.moveaxis(power, 0, 1))
    return np.stack(found) if found else None


def by_ways(powers: FloatArray, asked: np.ndarray) -> tuple[FloatArray, FloatArray, np.ndarray]:
    """Response in each way of `powers` (M, C + axes, L, axes), (W, C, L), its deviation in dB, (C, L), and the axes
    that are told, (axes, L). `asked` (C, L): where a channel's gain is known.

    A channel tells of an axis that makes `HEARS` of its response, and not where the model brings nothing to it. What a
    channel hears of both adds up, the phase between them being unknown. A line of which all channels tell one axis
    has that one in every way; NaN where a channel tells none.
    """
    count = powers.shape[3]
    mean = np.exp(np.log(powers + 1e-300).mean(axis=0))
    ring, mean = np.stack([mean[k - count, :, k] for k in range(count)]), np.moveaxis(mean[:-count], 2, 0)
    tells = (mean >= HEARS * mean.sum(axis=0)) & (mean >= CUT_OFF * ring[:, None, :]) & asked
    along = tells.any(axis=1)
    response, logs = [], []
    for way in ways():
        share = np.where(along.sum(axis=0) == 1, along, way[:, None])
        brought = np.log(np.einsum("mcla,al->mcl", powers[:, :-count], share) + 1e-300)
        response.append(np.where(tells.any(axis=0), np.exp(brought.mean(axis=0)), np.nan))
        logs.append(brought)
    return np.stack(response), np.asarray(logs[len(logs) // 2].std(axis=0) / PER_DB), along


def gain_errors_db(setting: Setting, healthy: Sequence[Healthy], hz: FloatArray) -> FloatArray:
    """(C, L): deviation of the gain, NaN outside the band in which it is calibrated.

    Lines of the baselines that stand out of the noise tell it, as well as the `healthy` machines agree on each line and
    the smooth gain on them; beside few of them the prior stays. Many lines tell it no better than one: what is wrong
    with a model is so at many. A sensor across the teeth's line of action hears little of a sound machine: its gain is
    known badly.
    """
    at = np.log2(np.maximum(hz, 1e-3))
    squares, count = np.zeros((2, len(setting.channels), hz.size))
    for one, lens, model in zip(setting.data, setting.seen_through, healthy, strict=True):
        seen = one.baseline if one.baseline is not None else one.test
        power = seen.line - LOBE * _noise(one, lens, one.lines_hz)
        told = power > STANDS_OUT * LOBE * _noise(one, lens, one.lines_hz)
        told &= np.stack([leading(row, one.lines_hz) for row in power])
        told &= np.stack([leading(row, one.lines_hz) for row in model.line])
        with np.errstate(invalid="ignore", divide="ignore"):
            off = 10.0 * np.log10(power / (model.line * lens.chain.line_gain(one.lines_hz)))
        apart = (np.log2(np.maximum(one.lines_hz, 1e-3))[:, None] - at[None, :]) / SMOOTH_OCTAVES
        kernel = np.where(np.abs(apart) < 2.0, np.exp(-0.5 * apart**2), 0.0)
        far = np.clip(np.nan_to_num(off), -FARTHEST_DB, FARTHEST_DB) ** 2 + model.line_spread_db**2
        squares += np.where(told, far, 0.0) @ kernel
        count += told @ kernel
    error = np.sqrt((squares + PRIOR_DB**2) / (count + 1.0))
    return np.where(count >= LEAST_TOLD, error, np.nan)


def _deviation(setting: Setting, number: int, test: _Side, before: _Side) -> FloatArray:
    """(C, L): of the difference, by what sound machines change at that line and by noise, whose floor under a line is
    not quite that beside it."""
    one, changes = setting.data[number], setting.changes
    rows = changes.null[:, changes.starts[number] : changes.starts[number + 1]]
    by_channel = rows.reshape(rows.shape[0], test.line.shape[0], -1)[:, :, : one.lines_hz.size]
    drift = np.sqrt(np.mean(np.clip(np.nan_to_num(by_channel, nan=UNKNOWN_DB), -MOST_DB, MOST_DB) ** 2, axis=0))
    further = test.line.shape[1] - one.lines_hz.size
    drift = np.concatenate([drift, np.full((drift.shape[0], further), UNKNOWN_DB)], axis=1)
    drifted = (np.exp(PER_DB * drift) - 1.0) * (before.line + SOFT * LOBE * before.noise)
    squares = [2.0 * side.line * side.noise + side.scatter**2 for side in (test, before)]
    louder = UNEVEN * LOBE * np.abs(test.noise - before.noise)
    return np.asarray(np.sqrt(drifted**2 + squares[0] + squares[1] + louder**2))
