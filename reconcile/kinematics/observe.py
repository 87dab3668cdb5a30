"""One recording as the level of kinematics sees it: speed, angle, envelopes of every channel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from reconcile.kinematics.envelopes import PARTS, ComplexArray, Envelopes, envelopes, whitened
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.slowest import MIN_TURNS, needed_for, shortest_s
from reconcile.speed import SpeedEstimate, estimate_speed, followed_angle, shaft_angle
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

if TYPE_CHECKING:
    from reconcile.kinematics.lines import OrderLines

MOST_DOUBT = 0.012
"""Share by which the search widens where the speed could not be read: wider, every comb meets every line."""
WHITE = 2
"""Channels whose transforms are kept: families are heard in this one or that one, by turns."""
SPEED_HARMONICS = (1, 2, 3)
"""Of the teeth, by which the mean speed is read."""
ANGLE_HARMONICS = 5
"""Of the teeth, by which its wander is followed."""


@dataclass(frozen=True)
class KeptBands:
    """Bands at equal angles, which one family asks for after the other: the latest, of `limit` bytes at most or one
    alone; beside them the transforms of the latest channels."""

    limit: int
    rows: dict[tuple[str, tuple[float, float]], tuple[FloatArray, int]] = field(default_factory=dict)
    white: dict[str, ComplexArray] = field(default_factory=dict)
    """Of the latest `WHITE` channels."""
    lines: dict[str, OrderLines | None] = field(default_factory=dict)
    """Order spectra of channels, each as large as its samples: shafts, teeth and their growth are read from them."""

    def of(
        self, key: tuple[str, tuple[float, float]], make: Callable[[], tuple[FloatArray, int]]
    ) -> tuple[FloatArray, int]:
        """As made before, or made now."""
        row = self.rows.pop(key, None) or make()
        row[0].flags.writeable = False
        self.rows[key] = row
        while len(self.rows) > 1 and sum(values.nbytes for values, _ in self.rows.values()) > self.limit:
            del self.rows[next(iter(self.rows))]
        return row


@dataclass(frozen=True, kw_only=True)
class Observation:
    """`doubt`: relative uncertainty of the reference shaft's speed, which widens every search."""

    label: str
    recording: Recording
    speed: SpeedEstimate
    doubt: float
    channels: tuple[Envelopes, ...]
    kept: KeptBands = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Nothing kept yet; as much may be as the recording takes."""
        object.__setattr__(self, "kept", KeptBands(self.recording.samples.nbytes))

    def channel(self, name: str) -> Envelopes | None:
        """Envelopes of a channel."""
        return next((e for e in self.channels if e.channel == name), None)

    def white(self, name: str) -> ComplexArray:
        """As `whitened`, of a channel's samples."""
        found = self.kept.white.get(name)
        return keep(self.kept.white, name, whitened(self.recording.series(name).samples)) if found is None else found


def keep(white: dict[str, ComplexArray], name: str, one: ComplexArray) -> ComplexArray:
    """A channel's transform put among the latest `WHITE`."""
    one.flags.writeable = False
    while len(white) >= WHITE:
        del white[next(iter(white))]
    white[name] = one
    return one


def observe(
    recording: Recording,
    ties: Ties,
    label: str,
    *,
    stated_hz: float | None,
    seed: int,
    parts: Sequence[int] = PARTS,
) -> Observation:
    """Speed, angle and envelopes (in bands that are `parts` of the range) of a recording that has passed the gate;
    SpecError names the field alone."""
    teeth = tuple(z * k for z in ties.mesh_orders for k in SPEED_HARMONICS)
    nyquist = recording.sampling_rate_hz / 2
    stated = recording.operating.speed_hz if recording.operating is not None else stated_hz
    if stated is not None and stated > 0.0 and recording.tacho is None:
        _long_enough(recording, ties, stated)
    usable = tuple(z for z in teeth if stated is not None and z * stated * 1.1 < nyquist)
    speed = estimate_speed(recording, shaft=ties.reference, stated_hz=stated, orders=usable, seed=seed)
    _long_enough(recording, ties, speed.speed_hz)
    angle = _angle(recording, speed, usable, ties)
    base, top = reach_of(ties.families)
    if top * speed.speed_hz * 2 > recording.sampling_rate_hz:
        allowed = f"at least {2 * top * speed.speed_hz:.5g}"
        message = f"is too low for the envelope lines of these parts at {speed.speed_hz:.4g} Hz"
        given = recording.sampling_rate_hz
        raise SpecError(Problem(field="sampling_rate_hz", message=message, given=given, allowed=allowed, unit="Hz"))
    doubt = min((speed.high_hz - speed.low_hz) / 2 / speed.speed_hz, MOST_DOUBT)
    white: dict[str, ComplexArray] = {}
    found = []
    for name in recording.names:
        known = keep(white, name, whitened(recording.series(name).samples))
        found.append(
            envelopes(
                recording, name, np.asarray(angle), highest_base=base, highest_order=top, white=known, parts=parts
            )
        )
    seen = Observation(label=label, recording=recording, speed=speed, doubt=float(doubt), channels=tuple(found))
    seen.kept.white.update(white)
    return seen


def _long_enough(recording: Recording, ties: Ties, speed_hz: float) -> None:
    """SpecError with all that it takes where the recording holds too few turns."""
    turns, seconds = speed_hz * recording.duration_s, recording.duration_s
    if turns < MIN_TURNS:
        least = f"at least {MIN_TURNS:g} turns, {shortest_s(speed_hz):g} s at {speed_hz:.4g} Hz"
        raise SpecError(
            Problem(
                field="samples",
                message=f"hold too few turns of {ties.reference}",
                given=f"{seconds:.4g} s, {turns:.3g} turns",
                allowed=f"{least}; better {needed_for(ties, speed_hz)}",
            )
        )


def _angle(recording: Recording, speed: SpeedEstimate, orders: Sequence[float], ties: Ties) -> FloatArray:
    """By all lines of the teeth where they tell how the speed wanders; else by pulses, or by what single channels give
    at the shaft's harmonics and `orders`."""
    if speed.method == "harmonics" and ties.mesh_orders:
        teeth = sorted(z * k for z in ties.mesh_orders for k in range(1, ANGLE_HARMONICS + 1))
        slowest = min(ties.shafts.values())
        rate = recording.sampling_rate_hz
        angle = followed_angle(recording.samples, rate, speed.speed_hz, orders=teeth, slowest=slowest)
        if angle is not None:
            return angle
    return shaft_angle(recording, speed, orders=orders)


def reach_of(families: tuple[Family, ...]) -> tuple[float, float]:
    """(highest base order, highest order of any line that is looked at)."""
    base = max(f.order for f in families)
    top = max(f.order * (1 + f.slip + MOST_DOUBT) * f.harmonics + f.sidebands * f.spacing for f in families)
    return base, 1.05 * top
