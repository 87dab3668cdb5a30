"""Finite elements of a cracked tooth on its gear body: plane stress, quadrilaterals of nine nodes.

One tooth stands on a piece of the body (a ring sector, clamped below and at its sides). Its bottom is the straight
crack from the flank's foot to the crack's tip, and from there a line to the other foot; the two faces of the crack have
nodes of their own. The sound tooth is the same mesh with those nodes tied, so what the point load and the corners do
locally cancels in the difference. Nothing is taken from the product but the gear's numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from sim.core.response import FloatArray
from sim.parts.gear.geometry import GearGeometry

GAUSS, WEIGHT = (-math.sqrt(0.6), 0.0, math.sqrt(0.6)), (5 / 9, 8 / 9, 5 / 9)


@dataclass(frozen=True, kw_only=True)
class Fineness:
    """Elements: across each half of the tooth, up the tooth, beside it, down the body; grading towards the crack."""

    across: int = 10
    up: int = 16
    beside: int = 6
    down: int = 10
    grading: float = 2.0


def _involute(gear: GearGeometry, alpha: FloatArray) -> FloatArray:
    """Points (x up the centre line, y across) of the loaded flank, y > 0."""
    b, left = gear.base_radius_m, gear.base_half_angle_rad - alpha
    return b * np.stack([np.cos(alpha) - left * np.sin(alpha), np.sin(alpha) + left * np.cos(alpha)], axis=-1)


def _graded(count: int, power: float) -> FloatArray:
    """2 count + 1 nodes on 0..1, crowded at 0."""
    ends = np.linspace(0.0, 1.0, count + 1) ** power
    return np.sort(np.concatenate([ends, 0.5 * (ends[1:] + ends[:-1])]))


def _blend(bottom: FloatArray, top: FloatArray, left: FloatArray, right: FloatArray, rows: FloatArray) -> FloatArray:
    """Transfinite interpolation: points (rows, columns, 2) between four edges that share their corners."""
    s = np.linspace(0.0, 1.0, bottom.shape[0])[None, :, None]
    t = rows[:, None, None]
    edges = (1 - t) * bottom[None] + t * top[None] + (1 - s) * left[:, None] + s * right[:, None]
    ends = (1 - s) * ((1 - t) * bottom[0] + t * top[0]) + s * ((1 - t) * bottom[-1] + t * top[-1])
    return np.asarray(edges - ends)


def _line(a: FloatArray, b: FloatArray, share: FloatArray) -> FloatArray:
    return np.asarray(a + share[:, None] * (b - a))


@dataclass(frozen=True, kw_only=True)
class CrackedTooth:
    """Nodes and elements of tooth and body; `foot` and `cover` are the nodes on the two faces of the crack."""

    points: FloatArray
    elements: np.ndarray
    clamped: np.ndarray
    flank: np.ndarray
    alpha_1_rad: FloatArray
    foot: np.ndarray
    cover: np.ndarray


def _shapes(x: float, y: float) -> tuple[FloatArray, FloatArray]:
    """Biquadratic shape functions (9,) and their derivatives (2, 9); nodes row by row."""
    line = [np.array([0.5 * r * (r - 1), 1 - r * r, 0.5 * r * (r + 1)]) for r in (x, y)]
    slope = [np.array([r - 0.5, -2 * r, r + 0.5]) for r in (x, y)]
    values = np.outer(line[1], line[0]).ravel()
    return values, np.stack([np.outer(line[1], slope[0]).ravel(), np.outer(slope[1], line[0]).ravel()])


def tooth_mesh(gear: GearGeometry, depth_m: float, angle_rad: float, fine: Fineness) -> CrackedTooth:
    """Mesh around a crack of a length (m) at an angle (rad) to the centre line, in and down from the loaded foot."""
    half, module = gear.base_half_angle_rad, gear.module_m
    tip_alpha = half - math.sqrt((gear.tip_radius_m / gear.base_radius_m) ** 2 - 1)
    up = _graded(fine.up, fine.grading)
    alpha = half + up * (tip_alpha - half)
    loaded = _involute(gear, alpha)
    other = loaded * [1.0, -1.0]
    tip = loaded[0] - depth_m * np.array([math.cos(angle_rad), math.sin(angle_rad)])
    share = _graded(fine.across, fine.grading)
    bottom = np.concatenate([_line(tip, other[0], share)[::-1], _line(tip, loaded[0], share)[1:]])
    top = _line(other[-1], loaded[-1], np.linspace(0.0, 1.0, bottom.shape[0]))
    tooth = _blend(bottom, top, other, loaded, up)
    foot_angle = math.atan2(loaded[0][1], loaded[0][0])
    reach = foot_angle + 4.0 * module / gear.base_radius_m
    beside = foot_angle + (reach - foot_angle) * _graded(fine.beside, fine.grading)
    arc = gear.base_radius_m * np.stack([np.cos(beside), np.sin(beside)], axis=-1)
    surface = np.concatenate([(arc * [1.0, -1.0])[::-1], bottom[1:-1], arc])
    floor_angle = np.concatenate([-beside[::-1], np.linspace(-foot_angle, foot_angle, bottom.shape[0])[1:-1], beside])
    floor = (gear.base_radius_m - 5.0 * module) * np.stack([np.cos(floor_angle), np.sin(floor_angle)], axis=-1)
    down = _graded(fine.down, fine.grading)
    body = (surface[None] + down[:, None, None] * (floor - surface)[None])[::-1]
    return _joined(tooth, body, fine, -alpha)


def quadrilaterals(ids: np.ndarray) -> list[np.ndarray]:
    """Nine nodes each, row by row, from a grid of an odd number of rows and columns."""
    rows, columns = ids.shape
    return [ids[i : i + 3, j : j + 3].ravel() for i in range(0, rows - 2, 2) for j in range(0, columns - 2, 2)]


def _joined(tooth: FloatArray, body: FloatArray, fine: Fineness, alpha_1: FloatArray) -> CrackedTooth:
    """One numbering: the tooth's bottom row is the body's last row from its other foot to the crack's tip."""
    rows, columns = body.shape[:2]
    body_id = np.arange(rows * columns).reshape(rows, columns)
    across, start = tooth.shape[1], 2 * fine.beside
    tooth_id = rows * columns + np.arange(tooth.shape[0] * across).reshape(tooth.shape[:2])
    cut = 2 * fine.across
    tooth_id[0, : cut + 1] = body_id[-1, start : start + cut + 1]
    points = np.concatenate([body.reshape(-1, 2), tooth.reshape(-1, 2)])
    return CrackedTooth(
        points=points,
        elements=np.array(quadrilaterals(body_id) + quadrilaterals(tooth_id)),
        clamped=np.unique(np.concatenate([body_id[0], body_id[:, 0], body_id[:, -1]])),
        flank=tooth_id[:, -1],
        alpha_1_rad=alpha_1,
        foot=body_id[-1, start + cut + 1 : start + across],
        cover=tooth_id[0, cut + 1 :],
    )


def plane_stress(points: FloatArray, elements: np.ndarray, young_pa: float, poisson: float) -> csc_matrix:
    """Stiffness of unit thickness, (2 nodes, 2 nodes), x and y of a node in turn; 3 x 3 Gauss points an element."""
    elastic = young_pa / (1 - poisson**2) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, 0.5 * (1 - poisson)]])
    at = points[elements]
    blocks = np.zeros((at.shape[0], 18, 18))
    for i, x in enumerate(GAUSS):
        for j, y in enumerate(GAUSS):
            slope = _shapes(x, y)[1]
            jacobian = np.einsum("rk,ekd->erd", slope, at)
            size = np.linalg.det(jacobian)
            assert np.all(size * size[0] > 0.0), "an element is turned inside out"
            grad = np.linalg.solve(jacobian, np.broadcast_to(slope, (at.shape[0], 2, 9)))
            strain = np.zeros((at.shape[0], 3, 18))
            strain[:, 0, 0::2] = strain[:, 2, 1::2] = grad[:, 0]
            strain[:, 1, 1::2] = strain[:, 2, 0::2] = grad[:, 1]
            weight = WEIGHT[i] * WEIGHT[j] * np.abs(size)
            blocks += np.einsum("e,eak,ab,ebl->ekl", weight, strain, elastic, strain, optimize=True)
    dofs = np.stack([2 * elements, 2 * elements + 1], axis=-1).reshape(at.shape[0], 18)
    row, column = np.repeat(dofs, 18, axis=1).ravel(), np.tile(dofs, (1, 18)).ravel()
    count = 2 * points.shape[0]
    return csc_matrix(coo_matrix((blocks.ravel(), (row, column)), shape=(count, count)))


def compliance_m_per_n(mesh: CrackedTooth, gear: GearGeometry, width_m: float, *, open_crack: bool) -> FloatArray:
    """Displacement of each flank node along a unit load on it, normal to the flank, m/N; the foot itself left out."""
    nodes = mesh.points.shape[0]
    master = np.arange(nodes)
    if not open_crack:
        master[mesh.cover] = mesh.foot
    free = np.ones(nodes, dtype=bool)
    free[mesh.clamped] = False
    used = np.unique(master[np.unique(mesh.elements)])
    used = used[free[used]]
    place = np.full(nodes, -1)
    place[used] = np.arange(used.size)
    place = place[master]
    row = np.flatnonzero(place >= 0)
    rows = np.concatenate([2 * row, 2 * row + 1])
    columns = np.concatenate([2 * place[row], 2 * place[row] + 1])
    tie = csc_matrix(coo_matrix((np.ones(rows.size), (rows, columns)), shape=(2 * nodes, 2 * used.size)))
    whole = plane_stress(mesh.points, mesh.elements, gear.youngs_modulus_pa, gear.poisson_ratio)
    solve = splu(csc_matrix(tie.T @ whole @ tie))
    found = []
    for node, alpha in zip(mesh.flank[1:], mesh.alpha_1_rad[1:], strict=True):
        load = np.zeros(2 * nodes)
        # normal to an involute: tangent to the base circle, down the centre line and across it
        load[2 * node : 2 * node + 2] = -math.sin(alpha), -math.cos(alpha)
        reduced = tie.T @ load
        found.append(float(reduced @ solve.solve(reduced)) / width_m)
    return np.array(found)
