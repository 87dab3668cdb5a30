"""The laws whose physics the product's registry has, under other names and in other forms."""

from __future__ import annotations

from collections.abc import Mapping

from proof.effects import (
    BEARINGS,
    GEARS,
    MESH,
    SHAFTS,
    Law,
    bearing,
    crack,
    eccentric,
    fit,
    loose,
    mesh,
    missing,
    mode,
    offset,
    pit,
    pitch,
    race,
    ripple,
    rub,
    shaft,
    shaft_crack,
    tooth,
    turning,
    wave,
)
from proof.model.layout import B, M, X

SPALL_LEVELS = (6e-4, 1e-3, 1.6e-3, 2.4e-3)

CLOSED: Mapping[str, Law] = {
    "loose_fit": Law(
        sites=BEARINGS, terms=("fit_clearance_series", "fit_clearance"), severity="gap", unit="m",
        levels=(5e-6, 1e-5, 2e-5, 4e-5), apply=fit, variants=3,
    ),
    "outer_pit": Law(
        sites=BEARINGS, terms=("outer_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=race(B.OUTER_WIDTH, B.OUTER_DEPTH, B.OUTER_ANGLE), variants=2,
    ),
    "inner_pit": Law(
        sites=BEARINGS, terms=("inner_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=race(B.INNER_WIDTH, B.INNER_DEPTH, B.INNER_ANGLE), variants=2,
    ),
    "ball_pit": Law(
        sites=BEARINGS, terms=("ball_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=race(B.BALL_WIDTH, B.BALL_DEPTH, B.BALL_ANGLE), variants=2,
    ),
    "root_crack": Law(
        sites=GEARS, terms=("tooth_crack",), severity="stiffness_loss", unit="1", levels=(0.04, 0.06, 0.085, 0.105),
        apply=tooth(crack), variants=2,
    ),
    "flank_pit": Law(
        sites=GEARS, terms=("tooth_spall",), severity="width", unit="1", levels=(0.6, 0.8, 0.95, 1.0),
        apply=tooth(pit),
    ),
    "broken_tooth": Law(
        sites=GEARS, terms=("missing_tooth",), severity="width", unit="1", levels=(0.2, 0.4, 0.7, 1.0),
        apply=tooth(missing),
    ),
    # bearings 1, 2 only: the tooth force presses the others so hard on their seats that these never lift
    "loose_seat": Law(
        sites=BEARINGS[:2], terms=("pedestal_looseness",), severity="loss", unit="1", levels=(0.2, 0.35, 0.5, 0.7),
        apply=loose, variants=2,
    ),
    "imbalance": Law(
        sites=GEARS, terms=("unbalance",), severity="moment", unit="kg*m", levels=(1e-3, 3e-3, 6e-3, 1.2e-2),
        apply=turning(X.UNBALANCE, X.UNBALANCE_PHASE),
    ),
    "run_out": Law(
        sites=GEARS, terms=("eccentricity",), severity="radius", unit="m", levels=(1e-5, 2e-5, 4e-5, 8e-5),
        apply=eccentric,
    ),
    "bow": Law(
        sites=GEARS, terms=("bent_shaft",), severity="bow", unit="m", levels=(5e-5, 1e-4, 2e-4, 4e-4),
        apply=turning(X.BOW, X.BOW_PHASE),
    ),
    "parallel_offset": Law(
        sites=SHAFTS, terms=("parallel_misalignment",), severity="offset", unit="m", levels=(2e-4, 5e-4, 1e-3, 2e-3),
        apply=offset,
    ),
    "joint_angle": Law(
        sites=SHAFTS, terms=("angular_misalignment",), severity="angle", unit="rad", levels=(0.03, 0.06, 0.12, 0.2),
        apply=turning(X.ANGLE, X.ANGLE_PHASE),
    ),
    "uneven_torque": Law(
        sites=SHAFTS, terms=("torque_ripple",), severity="amplitude", unit="N*m", levels=(1.0, 2.0, 4.0, 8.0),
        apply=ripple,
    ),
    "touching_ring": Law(
        sites=GEARS, terms=("rub",), severity="stiffness", unit="N/m", levels=(2e6, 5e6, 1e7, 3e7), apply=rub,
        sized=False,
    ),
    "play": Law(
        sites=MESH, terms=("backlash",), severity="width", unit="m", levels=(2e-5, 5e-5, 1e-4, 2e-4),
        apply=mesh(M.BACKLASH), sized=False,
        torque_nm=4.0,
    ),
    "flank_friction": Law(
        sites=MESH, terms=("tooth_friction",), severity="coefficient", unit="1", levels=(0.03, 0.06, 0.1, 0.15),
        apply=mesh(M.FRICTION),
    ),
    "tooth_pitch": Law(
        sites=GEARS, terms=("pitch_error",), severity="rms", unit="m", levels=(1e-6, 2e-6, 5e-6, 1e-5), apply=pitch,
        variants=2,
    ),
    "tooth_profile": Law(
        sites=GEARS, terms=("profile_error", "tip_relief"), severity="amplitude", unit="m",
        levels=(2e-6, 4e-6, 8e-6, 1.5e-5), apply=mesh(M.PROFILE), also_at={"pinion": ("gear",), "gear": ("pinion",)},
    ),
    "wider_clearance": Law(
        sites=BEARINGS, terms=("radial_clearance",), severity="change", unit="m", levels=(3e-6, 6e-6, 1.2e-5, 2.5e-5),
        apply=bearing(B.C0, add=True),
    ),
    "outer_waves": Law(
        sites=BEARINGS, terms=("outer_waviness",), severity="amplitude", unit="m", levels=(7e-7, 1.5e-6, 3e-6, 6e-6),
        apply=wave(B.OUTER_WAVE, B.OUTER_ORDER),
    ),
    "inner_waves": Law(
        sites=BEARINGS, terms=("inner_waviness",), severity="amplitude", unit="m", levels=(7e-7, 1.5e-6, 3e-6, 6e-6),
        apply=wave(B.INNER_WAVE, B.INNER_ORDER),
    ),
    "extra_mode": Law(
        sites=BEARINGS, terms=("support_mode",), severity="mass", unit="kg", levels=(0.05, 0.1, 0.2, 0.5), apply=mode,
    ),
    "load_stiffening": Law(
        sites=BEARINGS, terms=("bearing_stiffness",), severity="hardening", unit="1", levels=(0.2, 0.5, 1.0, 2.0),
        apply=bearing(B.HARDENING, B.HARDENING_AT, 1e-5),
    ),
    "breathing_crack": Law(
        sites=BEARINGS, terms=("shaft_crack",), severity="loss", unit="1", levels=(0.1, 0.2, 0.3, 0.5),
        apply=shaft_crack,
    ),
    "oil_film": Law(
        sites=BEARINGS, terms=("squeeze_film",), severity="damping", unit="N*s/m", levels=(2e3, 5e3, 1e4, 2e4),
        apply=bearing(B.FILM, B.FILM_GAP, 1e-4),
    ),
    "stiffening_coupling": Law(
        sites=SHAFTS, terms=("coupling_nonlinearity",), severity="hardening", unit="1", levels=(0.3, 0.6, 1.0, 2.0),
        apply=shaft(X.STIFFENING),
    ),
}  # fmt: skip
