"""What the sensors of a reconciliation tell about a force at a support, ready for `reconcile.machine.force`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.plan import Point, at_point
from reconcile.calibrate.chain import FARTHEST_DB, PRIOR_DB, SMOOTH_OCTAVES, STANDS_OUT, Healthy, leading
from reconcile.calibrate.uncertain import moved
from reconcile.judge.changes import Lens
from reconcile.machine.force import PER_DB, Heard
from reconcile.machine.local import MOST_DB, UNKNOWN_DB
from reconcile.machine.setting import Setting
from reconcile.observe.extract import hann_spectrum, line_powers
from reconcile.observe.features import SOFT
from reconcile.observe.observation import PointData
from reconcile.observe.statistics import LOBE, LOBE_SCATTER
from reconcile.observe.steady import Steady
from signals.series import FloatArray
from sim.assembly.assemble import assemble
from sim.assembly.receptance import receptances
from sim.core.errors import SidebandError
from sim.core.spec import MachineSpec

MACHINES = 12
"""Machines that agree with the baseline over which a response is averaged: 4 ms each to assemble."""
AXES = ("x", "y")
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
    """Lines of one operating point, `hz` (L,), as its channels hear a force at a support, and the axes they hear."""

    hz: FloatArray
    heard: Heard
    axes: tuple[str, ...]


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
    beside_hz: Sequence[float] = (),
) -> Reached | None:
    """The watched lines of an operating point and those at `beside_hz`; None without a baseline, or where no machine
    can be assembled."""
    one, lens = setting.data[number], setting.seen_through[number]
    if one.baseline is None or one.spectra[1] is None:
        return None
    hz = np.concatenate([one.lines_hz, np.asarray(beside_hz, dtype=np.float64)])
    powers = _responses(setting, one.point, site, machines, hz)
    if powers is None:
        return None
    response, spread = _by_axis(powers)
    error = gain_errors_db(setting, healthy, hz)
    gain = np.where(np.isfinite(error), lens.chain.line_gain(hz), np.nan)
    test, before = (
        np.concatenate([known.line, _powers(steady, beside_hz)], axis=1)
        for known, steady in ((one.test, one.spectra[0]), (one.baseline, one.spectra[1]))
    )
    noise = LOBE * _noise(one, lens, hz)
    heard = Heard(
        test=np.maximum(test - noise, 0.0),
        before=np.maximum(before - noise, 0.0),
        deviation=_deviation(setting, number, hz, test, before),
        response=gain * response,
        spread_db=np.hypot(spread, np.nan_to_num(error)),
    )
    axes = tuple(axis for k, axis in enumerate(AXES) if np.isfinite(heard.response[k]).any())
    return Reached(hz=hz, heard=heard, axes=axes)


def _noise(one: PointData, lens: Lens, hz: FloatArray) -> FloatArray:
    """Noise power in the noise bandwidth of a line, (C, L)."""
    return np.asarray(lens.chain.line_noise(hz) * one.test.resolution_hz)


def _powers(steady: Steady, hz: Sequence[float]) -> FloatArray:
    lines = np.asarray(hz, dtype=np.float64)
    _, power, bin_hz = hann_spectrum(steady.samples, steady.rate_hz)
    return line_powers(power, bin_hz, lines, np.zeros(lines.size), 0.5 * steady.rate_hz)


def _responses(
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


def _by_axis(powers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Response of `powers` (M, C + axes, L, axes) along each axis and its deviation in dB, both (axes, C, L).

    A channel tells of an axis that makes `HEARS` of its response, and not where the model brings nothing to it. Where
    both axes do, it is that to equal forces on both.
    """
    count = powers.shape[3]
    mean = np.exp(np.log(powers + 1e-300).mean(axis=0))
    ring, mean, powers = mean[-count:], mean[:-count], powers[:, :-count]
    total = mean.sum(axis=2)
    response, spread = [], []
    for k in range(count):
        other = count - 1 - k
        both = mean[..., other] >= HEARS * total
        logs = np.log(powers[..., k] + np.where(both, powers[..., other], 0.0) + 1e-300)
        told = (mean[..., k] >= HEARS * total) & (mean[..., k] >= CUT_OFF * ring[k, :, k])
        response.append(np.where(told, np.exp(logs.mean(axis=0)), np.nan))
        spread.append(logs.std(axis=0) / PER_DB)
    return np.stack(response), np.stack(spread)


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


def _deviation(setting: Setting, number: int, hz: FloatArray, test: FloatArray, before: FloatArray) -> FloatArray:
    """(C, L): of the difference, by what sound machines change at that line and by noise."""
    one, lens = setting.data[number], setting.seen_through[number]
    noise = _noise(one, lens, hz)
    changes = setting.changes
    rows = changes.null[:, changes.starts[number] : changes.starts[number + 1]]
    by_channel = rows.reshape(rows.shape[0], test.shape[0], -1)[:, :, : one.lines_hz.size]
    drift = np.sqrt(np.mean(np.clip(np.nan_to_num(by_channel, nan=UNKNOWN_DB), -MOST_DB, MOST_DB) ** 2, axis=0))
    drift = np.concatenate([drift, np.full((test.shape[0], hz.size - one.lines_hz.size), UNKNOWN_DB)], axis=1)
    drifted = (np.exp(PER_DB * drift) - 1.0) * (before + SOFT * LOBE * noise)
    squares = [2.0 * np.maximum(p - LOBE * noise, 0.0) * noise + (LOBE_SCATTER * noise) ** 2 for p in (test, before)]
    return np.asarray(np.sqrt(drifted**2 + squares[0] + squares[1]))
