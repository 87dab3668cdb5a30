"""Sums of orders as exact vectors, so that sums identical by construction are recognised, not compared as floats.

Every base is a rational multiple of a few independent symbols: one for each train of connected shafts, and for
each bearing geometry in a train one for its cage and one for its balls (their ratios to the shaft are treated as
irrational: a rational relation between them is a coincidence of dimensions, not of construction).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from signals.labels.kinematics import BearingKinematics, Kinematics, MeshKinematics
from sim.core.errors import Problem, SpecError
from sim.core.lines import Order

Vector = Mapping[str, Fraction]
VectorKey = tuple[tuple[str, Fraction], ...]
GEOMETRY_TOLERANCE = 1e-9
"""Relative difference below which two diameter ratios are one geometry: rounding of the frequencies they came from."""


def base_vectors(kinematics: Kinematics) -> dict[str, Vector]:
    """Each known base as a vector over the symbols."""
    shafts = _shaft_vectors(kinematics)
    vectors: dict[str, Vector] = dict(shafts)
    for mesh in kinematics.meshes:
        vectors[mesh.base] = _scaled(shafts[mesh.pinion_shaft], Fraction(mesh.pinion_teeth))
    geometries: list[tuple[str, float, float]] = []
    for bearing in kinematics.bearings:
        vectors.update(_bearing_vectors(bearing, shafts[bearing.shaft], geometries))
    return vectors


def vector_key(orders: Sequence[tuple[str, Order]], vectors: Mapping[str, Vector]) -> VectorKey:
    """The sum as a hashable vector; a base without known ties is its own symbol."""
    total: dict[str, Fraction] = {}
    for base, n in orders:
        for symbol, share in vectors.get(base, {base: Fraction(1)}).items():
            part = share if n == 1 else n * share  # most are a base once: sums of fractions are dear
            total[symbol] = total[symbol] + part if symbol in total else part
    return tuple(sorted((symbol, value) for symbol, value in total.items() if value))


def _shaft_vectors(kinematics: Kinematics) -> dict[str, Vector]:
    """Speeds of all shafts as multiples of one root shaft for each train."""
    names = [s.base for s in kinematics.shafts]
    names += [b for m in kinematics.meshes for b in (m.pinion_shaft, m.gear_shaft)]
    names += [b.shaft for b in kinematics.bearings]
    vectors: dict[str, Vector] = {}
    for name in dict.fromkeys(names):
        if name not in vectors:
            vectors[name] = {name: Fraction(1)}
            _spread(name, kinematics.meshes, vectors)
    for mesh in kinematics.meshes:
        given, due = vectors[mesh.gear_shaft], _scaled(vectors[mesh.pinion_shaft], _ratio(mesh))
        if given != due:
            message = "closes a train of gears with a ratio that contradicts the other meshes"
            raise SpecError(Problem(field=mesh.component, message=message, given=str(_ratio(mesh))))
    return vectors


def _spread(root: str, meshes: Sequence[MeshKinematics], vectors: dict[str, Vector]) -> None:
    """Fill the shafts reachable from `root` through meshes."""
    queue = [root]
    while queue:
        shaft = queue.pop()
        for mesh in meshes:
            ratio = _ratio(mesh)
            steps = ((mesh.pinion_shaft, mesh.gear_shaft, ratio), (mesh.gear_shaft, mesh.pinion_shaft, 1 / ratio))
            for here, there, factor in steps:
                if here == shaft and there not in vectors:
                    vectors[there] = _scaled(vectors[here], factor)
                    queue.append(there)


def _ratio(mesh: MeshKinematics) -> Fraction:
    return Fraction(mesh.pinion_teeth, mesh.gear_teeth)


def _bearing_vectors(
    bearing: BearingKinematics, shaft: Vector, geometries: list[tuple[str, float, float]]
) -> dict[str, Vector]:
    """f_c and f_b are symbols of the geometry scaled with the shaft; f_o = Z f_c, f_i = Z (f_r - f_c)."""
    ((root, ratio),) = shaft.items()
    cage = _geometry(geometries, f"cage:{root}", bearing.diameter_ratio, 0.0)
    ball = _geometry(geometries, f"ball:{root}", bearing.diameter_ratio, bearing.ball_order)
    z = bearing.balls
    return {
        bearing.base("c"): {cage: ratio},
        bearing.base("o"): {cage: z * ratio},
        bearing.base("i"): {root: z * ratio, cage: -z * ratio},
        bearing.base("b"): {ball: ratio},
    }


def _geometry(known: list[tuple[str, float, float]], kind: str, ratio: float, ball_order: float) -> str:
    """Symbol of a geometry, shared by all that equal it; `known` grows by new ones."""
    for i, (other_kind, other_ratio, other_order) in enumerate(known):
        if other_kind == kind and _same(other_ratio, ratio) and _same(other_order, ball_order):
            return f"{kind}:{i}"
    known.append((kind, ratio, ball_order))
    return f"{kind}:{len(known) - 1}"


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= GEOMETRY_TOLERANCE * max(abs(a), abs(b))


def _scaled(vector: Vector, factor: Fraction) -> Vector:
    return {symbol: share * factor for symbol, share in vector.items()}
