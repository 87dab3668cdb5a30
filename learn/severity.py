"""How long a race's spall is, in degrees of the race: entry and strike of a ball are that far apart.

The measure is `reconcile.kinematics.extent` (Sawalhi and Randall, Mech. Syst. Signal Process. 25 (2011) 846-870): it
needs no training. Balls have no such measure here.
"""

from __future__ import annotations

import math

from learn.features import Found
from learn.orders import FaultOrders
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.extent import Extent, spall_extent
from reconcile.kinematics.families import ties
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.spec import BearingOrders, KinematicBearing, KinematicShaft, KinematicSpec
from reconcile.speed import SpeedEstimate
from signals.recording import Recording

SHAFT, SITE = "shaft", "bearing"


def extent(recording: Recording, found: Found, orders: FaultOrders, speed_hz: float) -> Extent | None:
    """Extent of the spall whose lines were found; None for balls and where the record does not resolve it."""
    if found.family not in ("outer", "inner"):
        return None
    told = BearingOrders(bpfo=orders.outer, bpfi=orders.inner, bsf=orders.ball / 2, ftf=orders.cage)
    spec = KinematicSpec(
        shafts=[KinematicShaft(name=SHAFT, speed_hz=speed_hz)],
        bearings=[KinematicBearing(name=SITE, shaft=SHAFT, orders=told)],
    )
    tied = ties(spec)
    family = next(f for f in tied.families if f.kind == found.family)
    channel = recording.names[found.channel]
    evidence = Evidence(
        family=family,
        z=found.z,
        chance=10.0**-found.chance,
        slip=found.slip,
        order=found.order,
        channel=channel,
        band_hz=found.band_hz,
        depth=found.depth,
        channel_z={channel: found.z},
    )
    speed = SpeedEstimate(
        shaft=SHAFT,
        speed_hz=speed_hz,
        low_hz=speed_hz,
        high_hz=speed_hz,
        confidence=1.0,
        method="stated",
        stated_hz=speed_hz,
    )
    seen = Observation(label="recording", recording=recording, speed=speed, doubt=0.0, channels=())
    answer = spall_extent(evidence, seen, tied)
    return answer if answer is None or math.isfinite(answer.degrees) else None
