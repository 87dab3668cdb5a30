"""Families of lines that a machine's kinematics allow, within a stated bound on orders.

Ball pass, ball spin and cage lines with their sidebands: R. B. Randall and J. Antoni, "Rolling element bearing
diagnostics - a tutorial", Mech. Syst. Signal Process. 25 (2011) 485-520, section 2. A kinematic line says where a
line may be, not that anything excites it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from signals.labels.kinematics import BearingKinematics, Kinematics, MeshKinematics
from sim.core.lines import Line

MECHANISM = "kinematic"


@dataclass(frozen=True, kw_only=True)
class Bound:
    """Largest orders looked at: harmonics of each family, sidebands on each side, and in combinations (j f_m with up to
    two modulating bases, only for peaks that no family explains) the largest |order| of a shaft, of a bearing and
    of a second mesh; that of the first mesh is bounded by the spectrum.

    `series_shaft_sidebands`, `series_cage_sidebands`: sidebands of a defect's series (`signals.labels.series`), whose
    own order the spectrum bounds.
    `ambiguity_weight`: a sum competes for a peak that a simpler sum explains only if its |orders| add up to no more.
    """

    mesh: int = 20
    mesh_shaft_sidebands: int = 5
    mesh_outer_sidebands: int = 2
    shaft: int = 10
    outer: int = 20
    inner: int = 10
    inner_shaft_sidebands: int = 2
    ball: int = 5
    ball_cage_sidebands: int = 2
    cage: int = 5
    series_shaft_sidebands: int = 12
    series_cage_sidebands: int = 10
    combination_shaft: int = 5
    combination_outer: int = 24
    combination_mesh: int = 20
    ambiguity_weight: int = 12


def kinematic_lines(
    kinematics: Kinematics,
    bases_hz: Mapping[str, float],
    *,
    max_frequency_hz: float,
    bound: Bound | None = None,
) -> tuple[Line, ...]:
    """All lines of the families in (0, max_frequency_hz], not yet merged. Bases missing from `bases_hz` have none."""
    limits = bound or Bound()
    lines: list[Line] = []
    for shaft in kinematics.shafts:
        lines += [predicted({shaft.base: k}, shaft.component, "shaft") for k in range(1, limits.shaft + 1)]
    for mesh in kinematics.meshes:
        lines += _mesh(mesh, kinematics.bearings, limits)
    for bearing in kinematics.bearings:
        lines += _bearing(bearing, limits)
    known = [x for x in lines if all(base in bases_hz for base, _ in x.orders)]
    return tuple(x for x in known if 0 < x.frequency_hz(bases_hz) <= max_frequency_hz)


def _mesh(mesh: MeshKinematics, bearings: tuple[BearingKinematics, ...], bound: Bound) -> Iterator[Line]:
    """k f_m, k f_m +- n f_r of both shafts, k f_m +- n f_o of the bearings on them."""
    shafts = ((mesh.pinion_shaft, mesh.pinion), (mesh.gear_shaft, mesh.gear))
    carried = [b for b in bearings if b.shaft in (mesh.pinion_shaft, mesh.gear_shaft)]
    for k in range(1, bound.mesh + 1):
        yield predicted({mesh.base: k}, mesh.component, "mesh")
        for shaft, component in shafts:
            for n in both_signs(bound.mesh_shaft_sidebands):
                yield predicted({mesh.base: k, shaft: n}, component, "mesh")
        for bearing in carried:
            for n in both_signs(bound.mesh_outer_sidebands):
                yield predicted({mesh.base: k, bearing.base("o"): n}, bearing.site, "mesh")


def _bearing(bearing: BearingKinematics, bound: Bound) -> Iterator[Line]:
    """k f_o; k f_i +- n f_r; 2 k f_b +- n f_c (a ball defect strikes both races); k f_c."""
    o, i, b, c = (bearing.base(letter) for letter in "oibc")
    site = bearing.site
    for k in range(1, bound.outer + 1):
        yield predicted({o: k}, site, "outer")
    for k in range(1, bound.inner + 1):
        for n in (0, *both_signs(bound.inner_shaft_sidebands)):
            yield predicted({i: k, bearing.shaft: n}, site, "inner")
    for k in range(1, bound.ball + 1):
        for n in (0, *both_signs(bound.ball_cage_sidebands)):
            yield predicted({b: 2 * k, c: n}, site, "ball")
    for k in range(1, bound.cage + 1):
        yield predicted({c: k}, site, "cage")


def both_signs(count: int) -> tuple[int, ...]:
    """-1, 1, -2, 2 ... up to `count`."""
    return tuple(s * n for n in range(1, count + 1) for s in (-1, 1))


def predicted(orders: Mapping[str, int], component: str, family: str, mechanism: str = MECHANISM) -> Line:
    """A line with its zero orders dropped."""
    kept = tuple((base, n) for base, n in orders.items() if n)
    return Line(orders=kept, component=component, mechanism=mechanism, family=family)
