"""Pictures of a mesh: its tooth pairs over the path of contact, its stiffness and its error over the angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sim.core.laws import TOOTH_POINTS, MeshLaw
from sim.core.response import FloatArray
from sim.parts.mesh_element import zero_row
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.carried import ERROR, STIFFNESS, carried, mean_load_n
from sim.solve.law_picture.panel import Axis, Curve, Panel
from sim.solve.law_picture.scale import telling_reach
from sim.solve.law_picture.side import Side

POINTS = 241
POINTS_A_TOOTH, MOST_POINTS = 48, 1600
AROUND = 2
"""Teeth shown on either side of the odd one."""
ALIKE = 3
"""Teeth shown where all are alike."""
BEYOND_PLAY = 1.5


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """One mesh on both machines; `without` is None for what every mesh has."""

    law: MeshLaw
    bench: Bench
    without: Bench | None
    turning: str
    """The gear over whose angle things are drawn."""
    teeth: int


def mesh_panels(here: Side, without: Side | None, name: str, site: str) -> list[Panel]:
    """Every picture of the mesh that shows the effect at `site`."""
    law = here.laws.meshes[name]
    on_gear = site == law.gear
    mesh = Mesh(
        law=law,
        bench=Bench(system=here.system, element=here.elements[name]),
        without=None if without is None else Bench(system=without.system, element=without.elements[name]),
        turning=law.gear if on_gear else law.pinion,
        teeth=law.teeth[1] if on_gear else law.teeth[0],
    )
    panels: list[Panel | None] = [] if without is None else list(_pair_panels(mesh, without.laws.meshes[name]))
    softer = without is None or any(panel is not None and panel.telling for panel in panels[:1])
    panels += [_stiffness(mesh), _loaded_error(mesh)] if softer else [_loaded_error(mesh), _stiffness(mesh)]
    if without is None or _play(law) != _play(without.laws.meshes[name]):
        panels.insert(0, _over_deflection(mesh))
    return [panel for panel in panels if panel is not None and panel.telling]


def _play(law: MeshLaw) -> tuple[float | None, int, float]:
    return law.backlash_m, law.slices, law.lead_rad


def _pair_panels(mesh: Mesh, sound: MeshLaw) -> list[Panel]:
    """Stiffness of the changed tooth's pair and metal missing from it, over the path of contact."""
    law = mesh.law
    if law.pair_rows is None or law.pair_ratios is None:
        return []
    lost, cut = (_worst(law, sound, part) for part in (0, 1))
    row = zero_row(law)
    place = np.linspace(0.0, 1.0, TOOTH_POINTS)
    rows = law.pair_rows[law.pair_rows.shape[0] // 2, row]
    whole = np.interp(place, np.linspace(0.0, 1.0, rows.size), rows)
    path_m = float(law.pair_ratios[row]) * 2.0 * math.pi * law.base_radii_m[0] / law.teeth[0]
    x = Axis(label="Distance along the path of contact", unit="m")
    where = "from the start to the end of action of one tooth pair, at the installed centre distance"
    return [
        Panel(
            title="Stiffness of the tooth pair",
            caption=f"Stiffness of the pair with the changed tooth, {where}.",
            x=x,
            values=place * path_m,
            y=Axis(label="Stiffness", unit="N/m"),
            curves=(Curve(name="", here=whole / (1.0 + whole * lost), without=whole),),
        ),
        Panel(
            title="Metal missing from the flank",
            caption=f"By how much the flank stands back, {where}.",
            x=x,
            values=place * path_m,
            y=Axis(label="Missing metal", unit="m"),
            curves=(Curve(name="", here=cut, without=np.zeros_like(cut)),),
        ),
    ]


def _worst(law: MeshLaw, sound: MeshLaw, part: int) -> FloatArray:
    """The largest change of a tooth's shape, (TOOTH_POINTS,): compliance m/N (part 0) or missing metal m (part 1)."""
    found = np.zeros(TOOTH_POINTS)
    for mine, other in ((law.pinion_shape, sound.pinion_shape), (law.gear_shape, sound.gear_shape)):
        if mine is None:
            continue
        change = mine[:, part] - (0.0 if other is None else other[:, part])
        row: FloatArray = change[int(np.argmax(np.max(np.abs(change), axis=1)))]
        if np.max(np.abs(row)) > np.max(np.abs(found)):
            found = row
    return found


def _over_deflection(mesh: Mesh) -> Panel:
    """Force over the deflection on the line of action at the installed centre distance, standing still."""

    law = _standing(mesh.bench)
    reach = max(telling_reach(law, "m"), BEYOND_PLAY * (mesh.law.backlash_m or 0.0))
    x = np.linspace(-reach, reach, POINTS)
    before = None if mesh.without is None else _standing(mesh.without)
    return Panel(
        title="Mesh force over deflection",
        caption=f"Force on the line of action of {mesh.law.name} over the deflection beyond the transmission error,"
        " gears not turning.",
        x=Axis(label="Deflection", unit="m"),
        values=x,
        y=Axis(label="Force", unit="N"),
        curves=(_curve(np.array([law(float(s)) for s in x]), before and np.array([before(float(s)) for s in x])),),
    )


def _curve(here: FloatArray, without: FloatArray | None) -> Curve:
    return Curve(name="", here=here, without=without)


def _standing(bench: Bench) -> Callable[[float], float]:
    """Force over the deflection beyond the transmission error, at the angle 0."""
    row = bench.row(0.0, still=True)
    error_m = float(bench.outputs(row, bench.zeros())[ERROR])

    def law(deflection_m: float) -> float:
        u = bench.zeros()
        u[0] = error_m + deflection_m
        return float(bench.force(row, u)[0])

    return law


def _angles(mesh: Mesh) -> tuple[FloatArray, FloatArray]:
    """Angles of the gear (n,) over one turn, and the times at which it stands there."""
    a_tooth = min(POINTS_A_TOOTH, MOST_POINTS // mesh.teeth)
    angle = 2.0 * math.pi * np.arange(a_tooth * mesh.teeth) / (a_tooth * mesh.teeth)
    return angle, angle / (2.0 * math.pi * mesh.bench.system.speeds_hz[mesh.turning])


def _window(mesh: Mesh, change: FloatArray | None) -> slice:
    """The part of the turn to show: around the one odd tooth, a few teeth where all are alike, or all of it."""
    teeth = mesh.teeth
    a_tooth = min(POINTS_A_TOOTH, MOST_POINTS // teeth)
    if change is None:
        return slice(0, ALIKE * a_tooth)
    rows = change.reshape(teeth, -1)
    size = float(np.max(np.abs(rows)))
    if np.mean(np.std(rows, axis=0)) <= 0.01 * size:
        return slice(0, ALIKE * a_tooth)
    touched = np.flatnonzero(np.max(np.abs(rows), axis=1) > 0.02 * size)
    if touched.size > teeth // 4:
        return slice(None)
    first, last = int(touched[0]), int(touched[-1])
    if last - first > teeth // 2:  # the odd tooth engages across the end of the turn
        return slice(None)
    return slice(max(first - AROUND, 0) * a_tooth, min(last + 1 + AROUND, teeth) * a_tooth)


def _stiffness(mesh: Mesh) -> Panel:
    """Sum over all pairs in contact."""
    angle, times = _angles(mesh)

    def curve(bench: Bench) -> FloatArray:
        u = bench.zeros()
        return np.array([bench.outputs(bench.row(float(t), still=True), u)[STIFFNESS] for t in times])

    here = curve(mesh.bench)
    other = None if mesh.without is None else curve(mesh.without)
    part = _window(mesh, None if other is None else here - other)
    return Panel(
        title="Mesh stiffness over the angle",
        caption=f"Sum over the tooth pairs of {mesh.law.name} in contact, shafts centred.",
        x=Axis(label=f"Angle of {mesh.turning}", unit="rad"),
        values=angle[part],
        y=Axis(label="Stiffness", unit="N/m"),
        curves=(_curve(here[part], None if other is None else other[part]),),
    )


def _loaded_error(mesh: Mesh) -> Panel | None:
    """Deflection on the line of action that carries the mean load, gears turned slowly; what the effect changes of it.

    The error of the machine itself is often many times larger, so the change is shown alone.
    """
    load_n = mean_load_n(mesh.law)
    angle, times = _angles(mesh)
    here = carried(mesh.bench, times, load_n)
    other = None if mesh.without is None else carried(mesh.without, times, load_n)
    if here is None or (mesh.without is not None and other is None):
        return None
    change = None if other is None else here - other
    part = _window(mesh, change)
    shown = here if change is None else change
    what = "Deflection" if change is None else "Change, by the effect, of the deflection"
    caption = f"{what} on the line of action of {mesh.law.name} that carries {abs(load_n):.4g} N, gears turned slowly."
    return Panel(
        title=f"{'T' if change is None else 'Change of the t'}ransmission error under the mean load",
        caption=caption,
        x=Axis(label=f"Angle of {mesh.turning}", unit="rad"),
        values=angle[part],
        y=Axis(label="Deflection", unit="m"),
        curves=(_curve(shown[part], None if change is None else np.zeros(shown[part].size)),),
    )
