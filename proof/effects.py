"""What can be hidden: each law changes the model's numbers, and says which registered terms describe it.

`terms` are the names of the product's registry that count as right; () marks physics that no library has. `levels` are
severities from faint to strong, in the unit of `severity` (the term's own severity parameter).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from proof.machine import Arrays
from proof.model.layout import B, M, Tooth, X

BEARINGS = ("bearing1", "bearing2", "bearing3", "bearing4")
GEARS = ("pinion", "gear")
SHAFTS = ("input", "output")
MESH = ("mesh1",)
Apply = Callable[[Arrays, int, float, int, np.random.Generator], None]


@dataclass(frozen=True, kw_only=True)
class Law:
    """One effect. `apply(arrays, index of the site, severity, variant, rng)` changes the arrays in place."""

    sites: tuple[str, ...]
    terms: tuple[str, ...]
    severity: str
    unit: str
    levels: tuple[float, float, float, float]
    apply: Apply
    variants: int = 1
    also_at: Mapping[str, tuple[str, ...]] | None = None
    """Other names of a site that count as the right place."""
    sized: bool = True
    """Whether the severity means the same in the product's term."""


def _turn(rng: np.random.Generator) -> float:
    return float(rng.uniform(-math.pi, math.pi))


def _fit(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    b = a.bearings[site]
    b[B.FIT] = 2.0 if variant == 2 else 1.0
    b[B.FIT_GAP] = value
    b[B.FIT_N] = 1.5 if variant == 1 else 1.2
    b[B.FIT_K] = (3e11 if variant == 1 else 6e9) * rng.uniform(0.8, 1.2)
    b[B.FIT_LOSS] = rng.uniform(2.0, 5.0)
    b[B.FIT_MU] = rng.uniform(0.08, 0.15)
    b[B.FIT_PRESLIDE] = rng.uniform(1e-6, 3e-6)
    b[B.FIT_SHARE] = rng.uniform(0.1, 0.3)


def _loose(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    b = a.bearings[site]
    b[B.LOOSE] = value
    b[B.LOOSE_LIFT] = 2e-6 * rng.uniform(-1.0, 1.0) if variant == 1 else 0.0
    b[B.LOOSE_SMOOTH] = rng.uniform(3e-7, 1e-6)


def _race(width: B, depth: B, angle: B) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        b = a.bearings[site]
        b[width] = value
        b[depth] = rng.uniform(6e-5, 1.5e-4)
        # the tooth force presses bearings 1, 2 towards +y and 3, 4 towards -y: a pit of the outer race in that zone
        loaded = 0.5 * math.pi if site < 2 else -0.5 * math.pi
        b[angle] = loaded + rng.uniform(-0.5, 0.5) if width is B.OUTER_WIDTH else _turn(rng)
        if variant == 1:
            b[B.SPALL_ENTRY], b[B.SPALL_EXIT], b[B.SPALL_PEAK] = 0.35, 0.15, 0.65

    return apply


def _wave(amplitude: B, order: B) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        b = a.bearings[site]
        b[amplitude] = value
        b[order] = float((6, 7, 8, 13)[int(rng.integers(0, 4))])
        b[B.WAVE_PHASE] = _turn(rng)

    return apply


def _bearing(column: B, at: B | None = None, scale: float = 0.0, *, add: bool = False) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        b = a.bearings[site]
        b[column] = b[column] + value if add else value
        if at is not None:
            b[at] = scale

    return apply


def _mode(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    b = a.bearings[site]
    b[B.MODE_MASS] = value
    b[B.MODE_HZ] = rng.uniform(500.0, 2500.0)
    b[B.MODE_ZETA] = rng.uniform(0.01, 0.04)
    b[B.MODE_AXIS] = 1.0


def _shaft_crack(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    a.bearings[site][B.CRACK] = value
    a.bearings[site][B.CRACK_PHASE] = _turn(rng)


def _tooth(change: Callable[[np.ndarray, float, int, np.random.Generator], None]) -> Apply:  # type: ignore[type-arg]
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        change(a.teeth[site, int(rng.integers(0, (23, 81)[site]))], value, variant, rng)

    return apply


def _crack(tooth: np.ndarray, value: float, variant: int, rng: np.random.Generator) -> None:  # type: ignore[type-arg]
    tooth[Tooth.CRACK], tooth[Tooth.CRACK_FORM] = value, float(variant)


def _pit(tooth: np.ndarray, value: float, variant: int, rng: np.random.Generator) -> None:  # type: ignore[type-arg]
    tooth[Tooth.SPALL] = min(value, 0.98)
    tooth[Tooth.SPALL_LENGTH] = rng.uniform(0.15, 0.35)
    tooth[Tooth.SPALL_CENTRE] = rng.uniform(0.4, 0.6)
    tooth[Tooth.SPALL_FLOOR] = rng.uniform(1e-5, 3e-5) if value > 0.99 else 0.0


def _missing(tooth: np.ndarray, value: float, variant: int, rng: np.random.Generator) -> None:  # type: ignore[type-arg]
    tooth[Tooth.MISSING] = min(value, 0.999)


def _pitch(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    n = (23, 81)[site]
    steps = rng.standard_normal(n)
    if variant == 1:  # neighbours alike, as a worn hob leaves them
        steps = np.convolve(np.concatenate([steps, steps]), [0.25, 0.5, 0.25], "same")[n // 2 : n // 2 + n]
    steps = steps - steps.mean()
    a.teeth[site, :n, Tooth.PITCH] = value * steps / float(np.std(steps))


def _eccentric(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    a.mesh[M.ECC + site], a.mesh[M.ECC_PHASE + site] = value, _turn(rng)


def _mesh(column: M) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        a.mesh[column + site] = value
        if column is M.FRICTION:
            a.mesh[M.FRICTION_SPEED] = 0.05

    return apply


def _turning(column: X, phase: X) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        a.x[column + site], a.x[phase + site] = value, _turn(rng)

    return apply


def _offset(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    a.x[X.OFFSET_FORCE + site] = 1e6 * value
    a.x[X.OFFSET_ODD + site] = rng.uniform(0.1, 0.3)
    a.x[X.OFFSET_PHASE + site] = _turn(rng)


def _ripple(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    a.x[X.RIPPLE + site], a.x[X.RIPPLE_PHASE + site] = value, _turn(rng)
    a.x[X.RIPPLE_ORDER + site] = float((2, 3, 4, 6)[int(rng.integers(0, 4))])


def _rub(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
    a.x[X.RUB_K + site] = value
    a.x[X.RUB_GAP + site] = rng.uniform(1.0e-5, 2.0e-5)
    a.x[X.RUB_MU + site] = rng.uniform(0.05, 0.2)
    a.x[X.RUB_LOSS + site] = rng.uniform(0.2, 1.0)


def _shaft(column: X) -> Apply:
    def apply(a: Arrays, site: int, value: float, variant: int, rng: np.random.Generator) -> None:
        a.x[column + site] = value

    return apply


SPALL_LEVELS = (6e-4, 1e-3, 1.6e-3, 2.4e-3)

CLOSED: Mapping[str, Law] = {
    "loose_fit": Law(
        sites=BEARINGS, terms=("fit_clearance_series", "fit_clearance"), severity="gap", unit="m",
        levels=(5e-6, 1e-5, 2e-5, 4e-5), apply=_fit, variants=3,
    ),
    "outer_pit": Law(
        sites=BEARINGS, terms=("outer_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=_race(B.OUTER_WIDTH, B.OUTER_DEPTH, B.OUTER_ANGLE), variants=2,
    ),
    "inner_pit": Law(
        sites=BEARINGS, terms=("inner_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=_race(B.INNER_WIDTH, B.INNER_DEPTH, B.INNER_ANGLE), variants=2,
    ),
    "ball_pit": Law(
        sites=BEARINGS, terms=("ball_spall",), severity="width", unit="m", levels=SPALL_LEVELS,
        apply=_race(B.BALL_WIDTH, B.BALL_DEPTH, B.BALL_ANGLE), variants=2,
    ),
    "root_crack": Law(
        sites=GEARS, terms=("tooth_crack",), severity="stiffness_loss", unit="1", levels=(0.02, 0.04, 0.07, 0.1),
        apply=_tooth(_crack), variants=2,
    ),
    "flank_pit": Law(
        sites=GEARS, terms=("tooth_spall",), severity="width", unit="1", levels=(0.6, 0.8, 0.95, 1.0),
        apply=_tooth(_pit),
    ),
    "broken_tooth": Law(
        sites=GEARS, terms=("missing_tooth",), severity="width", unit="1", levels=(0.2, 0.4, 0.7, 1.0),
        apply=_tooth(_missing),
    ),
    "loose_seat": Law(
        sites=BEARINGS, terms=("pedestal_looseness",), severity="loss", unit="1", levels=(0.2, 0.35, 0.5, 0.7),
        apply=_loose, variants=2,
    ),
    "imbalance": Law(
        sites=GEARS, terms=("unbalance",), severity="moment", unit="kg*m", levels=(3e-3, 6e-3, 1.2e-2, 2.4e-2),
        apply=_turning(X.UNBALANCE, X.UNBALANCE_PHASE),
    ),
    "run_out": Law(
        sites=GEARS, terms=("eccentricity",), severity="radius", unit="m", levels=(5e-6, 1e-5, 2e-5, 4e-5),
        apply=_eccentric,
    ),
    "bow": Law(
        sites=GEARS, terms=("bent_shaft",), severity="bow", unit="m", levels=(2e-5, 5e-5, 1e-4, 2e-4),
        apply=_turning(X.BOW, X.BOW_PHASE),
    ),
    "parallel_offset": Law(
        sites=SHAFTS, terms=("parallel_misalignment",), severity="offset", unit="m", levels=(2e-4, 5e-4, 1e-3, 2e-3),
        apply=_offset,
    ),
    "joint_angle": Law(
        sites=SHAFTS, terms=("angular_misalignment",), severity="angle", unit="rad", levels=(0.03, 0.06, 0.12, 0.2),
        apply=_turning(X.ANGLE, X.ANGLE_PHASE),
    ),
    "uneven_torque": Law(
        sites=SHAFTS, terms=("torque_ripple",), severity="amplitude", unit="N*m", levels=(1.0, 2.0, 4.0, 8.0),
        apply=_ripple,
    ),
    "touching_ring": Law(
        sites=GEARS, terms=("rub",), severity="stiffness", unit="N/m", levels=(2e6, 5e6, 1e7, 3e7), apply=_rub,
        sized=False,
    ),
    "play": Law(
        sites=MESH, terms=("backlash",), severity="width", unit="m", levels=(2e-5, 5e-5, 1e-4, 2e-4),
        apply=_mesh(M.BACKLASH), sized=False,
    ),
    "flank_friction": Law(
        sites=MESH, terms=("tooth_friction",), severity="coefficient", unit="1", levels=(0.03, 0.06, 0.1, 0.15),
        apply=_mesh(M.FRICTION),
    ),
    "tooth_pitch": Law(
        sites=GEARS, terms=("pitch_error",), severity="rms", unit="m", levels=(1e-6, 2e-6, 5e-6, 1e-5), apply=_pitch,
        variants=2,
    ),
    "tooth_profile": Law(
        sites=GEARS, terms=("profile_error", "tip_relief"), severity="amplitude", unit="m",
        levels=(2e-6, 4e-6, 8e-6, 1.5e-5), apply=_mesh(M.PROFILE), also_at={"pinion": ("gear",), "gear": ("pinion",)},
    ),
    "wider_clearance": Law(
        sites=BEARINGS, terms=("radial_clearance",), severity="change", unit="m", levels=(3e-6, 6e-6, 1.2e-5, 2.5e-5),
        apply=_bearing(B.C0, add=True),
    ),
    "outer_waves": Law(
        sites=BEARINGS, terms=("outer_waviness",), severity="amplitude", unit="m", levels=(3e-7, 7e-7, 1.5e-6, 3e-6),
        apply=_wave(B.OUTER_WAVE, B.OUTER_ORDER),
    ),
    "inner_waves": Law(
        sites=BEARINGS, terms=("inner_waviness",), severity="amplitude", unit="m", levels=(3e-7, 7e-7, 1.5e-6, 3e-6),
        apply=_wave(B.INNER_WAVE, B.INNER_ORDER),
    ),
    "extra_mode": Law(
        sites=BEARINGS, terms=("support_mode",), severity="mass", unit="kg", levels=(0.05, 0.1, 0.2, 0.5), apply=_mode,
    ),
    "load_stiffening": Law(
        sites=BEARINGS, terms=("bearing_stiffness",), severity="hardening", unit="1", levels=(0.2, 0.5, 1.0, 2.0),
        apply=_bearing(B.HARDENING, B.HARDENING_AT, 1e-5),
    ),
    "breathing_crack": Law(
        sites=BEARINGS, terms=("shaft_crack",), severity="loss", unit="1", levels=(0.1, 0.2, 0.3, 0.5),
        apply=_shaft_crack,
    ),
    "oil_film": Law(
        sites=BEARINGS, terms=("squeeze_film",), severity="damping", unit="N*s/m", levels=(2e3, 5e3, 1e4, 2e4),
        apply=_bearing(B.FILM, B.FILM_GAP, 1e-4),
    ),
    "stiffening_coupling": Law(
        sites=SHAFTS, terms=("coupling_nonlinearity",), severity="hardening", unit="1", levels=(0.3, 0.6, 1.0, 2.0),
        apply=_shaft(X.STIFFENING),
    ),
}  # fmt: skip
