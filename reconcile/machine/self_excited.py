"""Does the machine vibrate by itself? Tones fixed in Hz near one of its natural frequencies, with their multiples.

A film that pushes across, a seal, friction inside the rotor or a cutting tool feeds energy into a mode until something
stops its growth: the machine then whirls at about its own frequency whatever its speed, and what stops it makes
multiples (J. M. Vance, Rotordynamics of Turbomachinery, Wiley 1988, chapter 7). A drive's tone has no such place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from reconcile.gate.findings import Finding
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.response import Channel
from sim.core.spec import MachineSpec

LEAST_SHARE = 0.2
"""Of the power of a channel, at the place where it is loudest."""
NEAR = (0.7, 1.4)
"""Ratio to a natural frequency with contacts linearised: those of a rattling bearing stiffen or let go."""
HIGHEST_HZ = 2_000.0
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
        "That is how a self-excited vibration looks: a film or seal that pushes across, friction inside the rotor."
    )
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
    """None where no such tones are on every channel."""
    tones = {f.channel: f for f in findings if f.kind == "fixed_tones" and f.fault and f.tones_hz}
    if len(tones) < len(channels) or not tones:
        return None
    loudest = max(tones.values(), key=lambda f: f.severity)
    if loudest.severity < LEAST_SHARE:
        return None
    own = [hz for hz in natural_frequencies_hz(assemble(machine)) if 0.0 < hz < HIGHEST_HZ]
    for hz in loudest.tones_hz:
        near = [n for n in own if NEAR[0] <= hz / n <= NEAR[1]]
        if near and all(_has(f, hz) for f in tones.values()) and any(_has(loudest, k * hz) for k in MULTIPLES):
            ranked = sorted(channels, key=lambda c: -tones[c.name].severity)
            return SelfExcited(
                hz=hz,
                own_hz=min(near, key=lambda n: abs(hz / n - 1.0)),
                share=loudest.severity,
                places=tuple(dict.fromkeys(c.location for c in ranked)),
            )
    return None


def _has(found: Finding, hz: float) -> bool:
    return any(abs(tone / hz - 1.0) < SAME for tone in found.tones_hz)
