"""Does the machine vibrate by itself? Tones fixed in Hz near one of its natural frequencies, with their multiples.

A film that pushes across, a seal, friction inside the rotor or a cutting tool feeds energy into a mode until something
stops its growth: the machine then whirls at about its own frequency whatever its speed, and what stops it makes
multiples (J. M. Vance, Rotordynamics of Turbomachinery, Wiley 1988, chapter 7). Another machine's tone may stand there
by chance, so that stays among what is not decided; on machines with teeth, whose modes are many, none is looked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.gate.findings import Finding
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.response import Channel
from sim.core.spec import MachineSpec

LEAST_SHARE = 0.2
"""Of the power of a channel, at the place where it is loudest."""
NEAR = (0.85, 1.2)
"""Ratio to a natural frequency with contacts linearised: those of a rattling bearing stiffen or let go (a concealed
whirl 1.16)."""
MOST_COVERED = 0.35
"""Share of the octaves from 30 Hz to `HIGHEST_HZ` that such ranges may cover: where modes are many, any tone is near
one."""
LOWEST_HZ, HIGHEST_HZ = 30.0, 2_000.0
SAME = 0.006
MULTIPLES = (2, 3)
RUN_DOWN = NextExperiment(
    sentence="Record a run-up or run-down: a self-excited vibration sets in at one speed and goes below another; a "
    "tone of a drive or a neighbour follows its source."
)


@dataclass(frozen=True, kw_only=True)
class SelfExcited:
    """A vibration at `hz` and multiples, near the machine's own `own_hz`; `places`: bearings, the loudest first."""

    hz: float
    own_hz: float
    share: float
    places: tuple[str, ...]
    lines: tuple[LineChange, ...] = ()

    follows = (
        "That is how a self-excited vibration looks (a film or seal that pushes across, friction inside the rotor), "
        "and how a tone of another machine or a drive may."
    )
    undecided = ("whether the machine does it by itself or the tone comes from another machine or a drive",)
    beside = "as a self-excited vibration has"
    would_tell = RUN_DOWN
    electric = True
    strikes = False

    @property
    def text(self) -> str:
        """What is seen."""
        return (
            f"the machine vibrates at {self.hz:.4g} Hz and multiples of it at every speed alike, new since the "
            f"baseline, near its natural frequency of {self.own_hz:.4g} Hz"
        )

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {"name": "self-excited", "hz": self.hz, "natural_hz": self.own_hz, "share": self.share}

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """The bearings at which it is heard, the loudest most."""
        known = [name for name in self.places if any(b.name == name for b in machine.bearings)]
        total = sum(0.5**k for k in range(len(known)))
        return tuple(PlaceWeight(site=name, weight=0.5**k / total) for k, name in enumerate(known))


def self_excited(machine: MachineSpec, findings: Sequence[Finding], channels: Sequence[Channel]) -> SelfExcited | None:
    """None where no such tones are on every channel, with teeth, and where modes leave no room to tell."""
    if machine.gears:
        return None
    tones = {f.channel: f for f in findings if f.kind == "fixed_tones" and f.fault and f.tones_hz}
    if len(tones) < len(channels) or not tones:
        return None
    loudest = max(tones.values(), key=lambda f: f.severity)
    if loudest.severity < LEAST_SHARE:
        return None
    own = [hz for hz in natural_frequencies_hz(assemble(machine)) if 0.0 < hz < HIGHEST_HZ]
    if covered(own) > MOST_COVERED:
        return None
    for hz in loudest.tones_hz:
        near = [n for n in own if NEAR[0] <= hz / n <= NEAR[1]]
        if any(_has(loudest, hz / k) for k in MULTIPLES):
            continue  # a multiple itself
        if near and all(_has(f, hz) for f in tones.values()) and any(_has(loudest, k * hz) for k in MULTIPLES):
            ranked = sorted(channels, key=lambda c: -tones[c.name].severity)
            return SelfExcited(
                hz=hz,
                own_hz=min(near, key=lambda n: abs(hz / n - 1.0)),
                share=loudest.severity,
                places=tuple(dict.fromkeys(c.location for c in ranked)),
            )
    return None


def covered(own_hz: Sequence[float]) -> float:
    """Share of the octaves from 30 Hz to `HIGHEST_HZ` that lies near a natural frequency."""
    grid = np.geomspace(LOWEST_HZ, HIGHEST_HZ, 2_000)
    ratio = grid[:, None] / np.asarray(own_hz, dtype=np.float64)[None]
    return float(np.mean(np.any((ratio >= NEAR[0]) & (ratio <= NEAR[1]), axis=1)))


def _has(found: Finding, hz: float) -> bool:
    return any(abs(tone / hz - 1.0) < SAME for tone in found.tones_hz)
