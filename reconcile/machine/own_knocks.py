"""Does something knock in its own time? Impacts whose distance stays in seconds while the shafts turn at other speeds.

A loose part that bounces, a valve, another machine: its impacts ring the same structure as a pitted race's and may be
named as one, but what a part of this machine strikes with keeps its distance in angle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from reconcile.kinematics.envelopes import squared_envelope, whitened
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from signals.series import FloatArray
from sim.core.response import Channel
from sim.core.spec import MachineSpec

APART = 1.15
"""Ratio of two speeds from which on a distance in angle is another one in seconds by far more than `SAME`."""
SAME = 0.03
LOWEST, HIGHEST = 0.05, 0.45
"""Band in which knocks are looked for, share of the sampling rate."""
RING_S, APART_S = 1e-3, 0.01
LOUD = 30.0
"""Energy of a knock over its median: knocks of 250 N on a rotor reach 2000, a rattling bearing's at most 15 mostly."""
FEWEST = 8
EVEN, EVEN_SHARE = 0.2, 0.6
"""Share of the distances that must be within so much of their median: what bounces comes late now and then."""
USUAL = 0.5
"""Share of the median within which a distance is one of theirs: the mean of those is their period."""
HEARD, TOGETHER_S = 4.0, 4e-3
"""Energy over its median with which another channel hears a knock, and within what time."""
FAIR = 0.25
"""Of the knocks' energy, from which what the baseline has is their like."""
LONG_ENOUGH = 0.7
"""Of the test's duration, which a baseline must have for its silence to say something."""
GLITCH = ("whether the machine knocks or the one sensor has glitches: a second one would hear a blow too",)
STOP = NextExperiment(
    sentence="Look for a loose part near the place named, and record a run-down: what knocks in its own time keeps it "
    "while the shafts slow down."
)


@dataclass(frozen=True, kw_only=True)
class OwnKnocks:
    """Impacts `hz` times a second at every speed, none or others in the baseline; `channel`: loudest there."""

    hz: float
    channel: str
    location: str
    speeds_hz: tuple[float, ...]
    lines: tuple[LineChange, ...] = ()

    follows = "They follow no shaft of this machine."
    beside = "which no part of this machine strikes at"
    would_tell = STOP
    electric = False
    strikes = True
    undecided: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """What is seen."""
        speeds = ", ".join(f"{hz:g}" for hz in self.speeds_hz)
        return (
            f"impacts come {self.hz:.3g} times a second, new since the baseline and alike at speeds of {speeds} Hz, "
            f"clearest on {self.channel}"
        )

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {"name": "own knocks", "hz": self.hz, "channel": self.channel}

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """The bearing that the channel stands at, if the machine has it."""
        return tuple(PlaceWeight(site=b.name, weight=1.0) for b in machine.bearings if b.name == self.location)


@dataclass(frozen=True, kw_only=True)
class Knocks:
    """Median distance, s, of a channel's knocks in one recording, and their median energy over the channel's."""

    every_s: float
    height: float


def own_knocks(data: Sequence[PointData], channels: Sequence[Channel]) -> OwnKnocks | None:
    """None where nothing of the kind stands out in every test, at one speed, and without baselines long enough."""
    speeds = [d.spectra[0].speed_hz for d in data]
    if max(speeds) < APART * min(speeds):
        return None
    found = [(c, one) for k, c in enumerate(channels) if (one := _alike(data, k)) is not None]
    if not found:
        return None
    channel, loudest = max(found, key=lambda one: one[1].height)
    if len(channels) > 1 and not _heard_elsewhere(data, channels.index(channel)):
        return None
    return OwnKnocks(
        hz=1.0 / loudest.every_s,
        channel=channel.name,
        location=channel.location,
        speeds_hz=tuple(round(hz, 1) for hz in speeds),
        undecided=GLITCH if len(channels) == 1 else (),
    )


def _alike(data: Sequence[PointData], channel: int) -> Knocks | None:
    """The knocks of a channel where all tests have them at one distance in seconds, and no baseline has as many."""
    seen = []
    for one in data:
        now, then = one.spectra
        knocks = knocks_of(now, channel)
        if then is None or knocks is None or not _new(now, then, channel, knocks.height):
            return None
        seen.append(knocks)
    middle = float(np.median([k.every_s for k in seen]))
    if any(abs(k.every_s / middle - 1.0) >= SAME for k in seen):
        return None
    return Knocks(every_s=middle, height=float(np.median([k.height for k in seen])))


def _new(now: Steady, then: Steady, channel: int, height: float) -> bool:
    """Whether the baseline is long enough to have as many knocks and has not half as many of a fair height, even or
    not; a bearing that rattles has some of its own."""
    spans = [one.samples.shape[1] / one.rate_hz for one in (now, then)]
    if spans[1] < LONG_ENOUGH * spans[0] or channel >= then.samples.shape[0]:
        return False
    fair = max(0.5 * LOUD, FAIR * height)
    rates = [_tops(one, channel, fair)[0].size / span for one, span in zip((now, then), spans, strict=True)]
    return bool(rates[1] < 0.5 * rates[0])


def _heard_elsewhere(data: Sequence[PointData], channel: int) -> bool:
    """Whether another channel hears this one's knocks at the same moments: a sensor's glitch stays in its cable."""
    for one in data:
        now = one.spectra[0]
        at, _ = _tops(now, channel, LOUD)
        others = [_tops(now, k, HEARD)[0] for k in range(now.samples.shape[0]) if k != channel]
        shares = [float(np.mean(np.abs(at[:, None] - o[None]).min(axis=1) < TOGETHER_S)) for o in others if o.size]
        if max(shares, default=0.0) < 0.5:
            return False
    return True


def _tops(one: Steady, channel: int, loud: float) -> tuple[FloatArray, FloatArray]:
    """Times, s, and energies over its median, of what stands out of a channel, both of shape (knocks,)."""
    rate = one.rate_hz
    square, fine, _ = squared_envelope(
        whitened(one.samples[channel]), LOWEST * rate, HIGHEST * rate, rate, limit=np.inf
    )
    energy = uniform_filter1d(square, max(1, int(RING_S * fine)))
    over = energy / max(float(np.median(energy)), np.finfo(np.float64).tiny)
    top = (over == maximum_filter1d(over, 2 * int(APART_S * fine) + 1)) & (over > loud)
    return np.flatnonzero(top) / fine, over[top]


def knocks_of(one: Steady, channel: int) -> Knocks | None:
    """None where a channel has too few knocks, or no usual distance between them."""
    at, heights = _tops(one, channel, LOUD)
    if at.size < FEWEST:
        return None
    steps = np.diff(at)
    middle = float(np.median(steps))
    if np.mean(np.abs(steps / middle - 1.0) < EVEN) < EVEN_SHARE:
        return None
    usual = steps[np.abs(steps / middle - 1.0) < USUAL]
    return Knocks(every_s=float(np.mean(usual)), height=float(np.median(heights)))
