"""Families of lines a defect of each part would make, as orders of one reference shaft.

Ball pass, spin and cage: R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485-520, eqs (1)-(4),
through `sim.parts.bearing`. A defect on the outer ring strikes at BPFO; on the inner ring at BPFI, stronger in the load
zone, thus with sidebands of the shaft; on a ball at 2 BSF with sidebands of the cage; a local fault of a shaft or a
tooth once a turn.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Literal

from reconcile.kinematics.plausible import spin_of
from reconcile.kinematics.spec import BearingOrders, KinematicBearing, KinematicSpec, given_geometry
from sim.core.errors import Problem, SpecError
from sim.parts.bearing.catalogue import lookup
from sim.parts.bearing.frequencies import defect_orders

Kind = Literal["outer", "inner", "ball", "cage", "turn"]
SLIP = 0.025
"""Balls do not roll exactly: orders 1-2 % from the drawing's are common (Randall & Antoni 2011, section 2)."""
HARMONICS = {"outer": 4, "inner": 3, "ball": 3, "cage": 4, "turn": 8}


@dataclass(frozen=True, kw_only=True)
class Family:
    """Harmonics k `order` with `sidebands` pairs at multiples of `spacing`, orders of the reference shaft."""

    kind: Kind
    site: str
    order: float
    spacing: float
    sidebands: int
    slip: float
    """Share by which the order may differ from the drawing's; 0 where teeth and shafts fix it."""
    lowest: int = 1
    """Harmonic from which on the family is looked for."""

    @property
    def key(self) -> str:
        """`bearing1.outer`."""
        return f"{self.site}.{self.kind}"

    @property
    def harmonics(self) -> int:
        """Harmonics that are looked at."""
        return HARMONICS[self.kind]


@dataclass(frozen=True, kw_only=True)
class Race:
    """Sizes of a bearing that turn times into angles: `spacing_deg` between balls; the diameters may be unknown."""

    balls: int
    ratio: float
    pitch_m: float | None
    cage: float
    """FTF over the speed of its shaft."""


@dataclass(frozen=True, kw_only=True)
class Ties:
    """All of a specification over its reference shaft: shaft ratios, families, meshes (name, order, two shafts)."""

    reference: str
    shafts: dict[str, float]
    families: tuple[Family, ...]
    meshes: tuple[tuple[str, float, tuple[str, str], tuple[str, str]], ...]
    """(mesh, order, names of its shafts, names of its gears)."""
    races: dict[str, Race]

    @property
    def lowest_order(self) -> float:
        """Of what turns slowest."""
        return min([*self.shafts.values(), *(f.order for f in self.families if f.kind == "cage")])

    @property
    def mesh_orders(self) -> tuple[float, ...]:
        """Orders of the meshes."""
        return tuple(m[1] for m in self.meshes)


def ties(spec: KinematicSpec, reference: str | None = None) -> Ties:
    """Families of `spec` over the shaft `reference` (default: the only one, or the first).

    SpecError for a shaft that is not there. That holds for a machine of one shaft too: the speed of a motor is not
    that of the fan which a belt drives, and pulses of another name would be left unused.
    """
    names = [s.name for s in spec.shafts]
    shaft = names[0] if reference is None else (reference if reference in names else None)
    if shaft is None:
        raise SpecError(
            Problem(
                field="operating.shaft",
                message="is no shaft of the specification",
                given=reference,
                allowed=", ".join(names),
            )
        )
    ratios = _ratios(spec, shaft)
    families: list[Family] = []
    races: dict[str, Race] = {}
    for bearing in spec.bearings:
        orders, race = _bearing(bearing)
        races[bearing.name] = race
        families += _families(bearing.name, orders, ratios[bearing.shaft])
    families += [
        Family(kind="turn", site=name, order=ratio, spacing=ratio, sidebands=0, slip=0.0)
        for name, ratio in ratios.items()
    ]
    gears = {g.name: g for g in spec.gears}
    meshes = tuple(
        (
            m.name,
            gears[m.gears[0]].teeth * ratios[gears[m.gears[0]].shaft],
            (gears[m.gears[0]].shaft, gears[m.gears[1]].shaft),
            (m.gears[0], m.gears[1]),
        )
        for m in spec.meshes
    )
    return Ties(reference=shaft, shafts=ratios, families=tuple(families), meshes=meshes, races=races)


def _ratios(spec: KinematicSpec, reference: str) -> dict[str, float]:
    """Speed of each shaft over the reference's: through the meshes, else by the stated speeds."""
    gears = {g.name: g for g in spec.gears}
    ratio = {reference: 1.0}
    queue = deque([reference])
    while queue:
        here = queue.popleft()
        for mesh in spec.meshes:
            a, b = (gears[n] for n in mesh.gears)
            for one, other in ((a, b), (b, a)):
                if one.shaft == here and other.shaft not in ratio:
                    ratio[other.shaft] = ratio[here] * one.teeth / other.teeth
                    queue.append(other.shaft)
    stated = {s.name: s.speed_hz for s in spec.shafts}
    base = stated[reference]
    for name, speed in stated.items():
        if name in ratio:
            continue
        if speed is None or base is None:
            message = f"is tied to {reference} by no mesh: both need speed_hz"
            raise SpecError(
                Problem(field=f"kinematics.shafts.{name}.speed_hz", message=message, allowed="above 0", unit="Hz")
            )
        ratio[name] = speed / base
    return ratio


def _bearing(bearing: KinematicBearing) -> tuple[BearingOrders, Race]:
    """Orders per turn of its shaft, and its sizes."""
    if bearing.orders is not None:
        o = bearing.orders
        balls = max(3, round(o.bpfo + o.bpfi))
        gamma = max((o.bpfi - o.bpfo) / (o.bpfi + o.bpfo), 0.02)
        spin = spin_of(o.bpfo, o.bpfi, o.bsf) if o.bsf is not None else (1 - gamma**2) / (2 * gamma)
        cage = o.ftf if o.ftf is not None else o.bpfo / (o.bpfo + o.bpfi)
        return BearingOrders(bpfo=o.bpfo, bpfi=o.bpfi, bsf=spin, ftf=cage), Race(
            balls=balls, ratio=gamma, pitch_m=None, cage=cage
        )
    geometry = lookup(bearing.catalogue).geometry() if bearing.catalogue is not None else given_geometry(bearing)
    found = defect_orders(geometry)
    orders = BearingOrders(bpfo=found.outer_pass, bpfi=found.inner_pass, bsf=found.ball_spin, ftf=found.cage)
    pitch = geometry.pitch_diameter_m
    return orders, Race(balls=geometry.balls, ratio=geometry.diameter_ratio, pitch_m=pitch, cage=found.cage)


def _families(site: str, orders: BearingOrders, shaft: float) -> list[Family]:
    """The four families of a bearing on a shaft that turns `shaft` times as fast as the reference."""
    spin, cage = float(orders.bsf or 0.0), float(orders.ftf or 0.0)
    rows: tuple[tuple[Kind, float, float, int], ...] = (
        ("outer", orders.bpfo, 0.0, 0),
        ("inner", orders.bpfi, 1.0, 1),
        ("ball", 2 * spin, cage, 1),
        ("cage", cage, 0.0, 0),
    )
    return [
        Family(kind=kind, site=site, order=o * shaft, spacing=s * shaft, sidebands=n, slip=SLIP)
        for kind, o, s, n in rows
    ]
