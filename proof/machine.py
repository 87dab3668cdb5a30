"""The nominal machine, its hidden copies, and the arrays the compiled model reads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from proof.model.layout import BALLS, TEETH, B, G, M, Tooth, X

FloatArray = np.ndarray[Any, np.dtype[np.float64]]

NOMINAL: Mapping[str, float] = {
    "If1": 0.0021, "Ip": 0.0004365, "Ig": 0.008362, "If2": 0.0105, "mp_": 0.96, "mg": 2.88,
    "kf": 4.4e4, "cf": 5.0, "ks": 6.56e7, "cs": 1.8e3, "kp": 6.56e7, "cp": 1.8e3, "kr": 2.5e8, "cr": 1.8e3,
    "ms": 0.4, "mo": 0.1, "mr": 0.5, "kre": 8e9, "c0": 2e-6, "e0": 3e-5, "em": 2e-5, "phi": 0.0, "ct": 1456.8,
    "fr1": 30.0, "T": 25.0, "z1": 23.0, "z2": 81.0, "m": 0.002, "W": 0.024, "al": 20.0,
}  # fmt: skip
"""The reference solutions' lightly damped machine; SI, `al` in degrees."""
SPREAD = 0.1
"""Half width of the uniform distribution of the hidden parameters, as a share of the nominal value."""
DRIFT = 0.15
"""Standard deviation of the drift between baseline and test over that of the hidden parameters."""
HIDDEN = (
    "If1", "Ip", "Ig", "If2", "mp_", "mg", "kf", "cf", "ks", "cs", "kp", "cp", "kr", "cr",
    "ms", "mo", "mr", "kre", "c0", "e0", "em", "ct", "T", "km",
)  # fmt: skip
OWN_BEARING = 0.02
"""Half width of each bearing's own deviation in stiffness."""
SETTLE_S = 0.25
RAMP_S = 0.05


@dataclass(frozen=True, kw_only=True)
class Rolling:
    """The drawing of all four bearings."""

    balls: int = 7
    pitch_diameter_m: float = 0.04
    ball_diameter_m: float = 0.010588


@dataclass(frozen=True, kw_only=True)
class Arrays:
    """What the compiled model reads: see `model.layout` for the columns. `spread` (4, balls, 3): angle, cos, sin."""

    g: FloatArray
    bearings: FloatArray
    mesh: FloatArray
    x: FloatArray
    teeth: FloatArray
    spread: FloatArray

    def all(self) -> tuple[FloatArray, ...]:
        """In the order of the compiled function."""
        return self.g, self.bearings, self.mesh, self.x, self.teeth, self.spread


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """One real machine: factors by parameter, each bearing's own factors (4, 4), ball angles' errors (4, BALLS) rad."""

    factors: Mapping[str, float]
    own: FloatArray
    ball_errors: FloatArray
    mesh_phase: float

    def drifted(self, rng: np.random.Generator) -> Hidden:
        """The machine some months later."""
        width = DRIFT * SPREAD / math.sqrt(3.0)
        factors = {name: value * (1.0 + width * rng.standard_normal()) for name, value in self.factors.items()}
        return Hidden(factors=factors, own=self.own, ball_errors=self.ball_errors, mesh_phase=self.mesh_phase)


def hidden_machine(rng: np.random.Generator) -> Hidden:
    """A machine whose parameters nobody knows better than `SPREAD`."""
    return Hidden(
        factors={name: 1.0 + SPREAD * rng.uniform(-1.0, 1.0) for name in HIDDEN},
        own=1.0 + OWN_BEARING * rng.uniform(-1.0, 1.0, (4, 4)),
        ball_errors=np.deg2rad(0.3) * rng.uniform(-1.0, 1.0, (4, BALLS)),
        mesh_phase=0.3 * rng.uniform(-1.0, 1.0),
    )


def exact_machine() -> Hidden:
    """The nominal machine itself."""
    return Hidden(
        factors=dict.fromkeys(HIDDEN, 1.0), own=np.ones((4, 4)), ball_errors=np.zeros((4, BALLS)), mesh_phase=0.0
    )


def contact_ratio(p: Mapping[str, float]) -> float:
    """Of standard involute gears without profile shift."""
    al = math.radians(p["al"])
    radii = [0.5 * p["m"] * p[z] for z in ("z1", "z2")]
    reach = sum(math.sqrt((r + p["m"]) ** 2 - (r * math.cos(al)) ** 2) for r in radii)
    return (reach - sum(radii) * math.sin(al)) / (math.pi * p["m"] * math.cos(al))


def pair_stiffness(p: Mapping[str, float]) -> float:
    """Of one pair of steel teeth, up to a factor: ISO 6336-1's q' without profile shift, times the face width."""
    return p["W"] / (0.04723 + 0.15551 / p["z1"] + 0.25791 / p["z2"])


def arrays_of(
    hidden: Hidden, nominal: Mapping[str, float] = NOMINAL, rolling: Rolling = Rolling(), *, ramp_s: float = RAMP_S
) -> Arrays:
    """The hidden machine without any effect."""
    p = {name: value * hidden.factors.get(name, 1.0) for name, value in nominal.items()}
    g = np.zeros(G.SIZE)
    al = math.radians(p["al"])
    rb1, rb2 = (0.5 * p["m"] * p[z] * math.cos(al) for z in ("z1", "z2"))
    named = {
        G.IF1: "If1", G.IP: "Ip", G.IG: "Ig", G.IF2: "If2", G.MP: "mp_", G.MG: "mg", G.KF1: "kf", G.KF2: "kf",
        G.CF: "cf", G.T: "T", G.Z1: "z1", G.Z2: "z2", G.EM: "em", G.E0: "e0", G.CT: "ct",
    }  # fmt: skip
    for place, name in named.items():
        g[place] = p[name]
    g[G.RB1], g[G.RB2] = rb1, rb2
    g[G.TOUT] = p["T"] * rb2 / rb1
    g[G.PHI] = p["phi"] + hidden.mesh_phase
    g[G.KM] = hidden.factors.get("km", 1.0) * (pair_stiffness(p) / pair_stiffness(NOMINAL))
    g[G.EPS] = contact_ratio(p)
    g[G.A0] = 0.5 * p["m"] * (p["z1"] + p["z2"])
    g[G.GOVERNOR] = 0.02 if ramp_s > 0.0 else 0.0
    g[G.RAMP] = ramp_s
    return Arrays(
        g=g,
        bearings=np.stack([_bearing(p, rolling, hidden.own[j]) for j in range(4)]),
        mesh=np.zeros(M.SIZE),
        x=np.zeros(X.SIZE),
        teeth=np.zeros((2, TEETH, Tooth.SIZE)),
        spread=spread_of(hidden, rolling.balls),
    )


def _bearing(p: Mapping[str, float], rolling: Rolling, own: FloatArray) -> FloatArray:
    b = np.zeros(B.SIZE)
    named = {
        B.CS: "cs", B.CP: "cp", B.CR: "cr", B.MS: "ms", B.MO: "mo", B.MR: "mr", B.C0: "c0",
    }  # fmt: skip
    for place, name in named.items():
        b[place] = p[name]
    b[B.KS] = p["ks"] * own[0]
    b[B.KPX] = b[B.KPY] = p["kp"] * own[1]
    b[B.KR] = p["kr"] * own[2]
    b[B.KRE] = p["kre"] * own[3]
    b[B.COUNT] = rolling.balls
    b[B.PITCH] = rolling.pitch_diameter_m
    b[B.RATIO] = rolling.ball_diameter_m / rolling.pitch_diameter_m
    b[B.SPALL_ENTRY], b[B.SPALL_EXIT], b[B.SPALL_PEAK] = 0.45, 0.25, 0.8
    return b


def spread_of(hidden: Hidden, balls: int) -> FloatArray:
    """Angle, cosine and sine of every ball of every bearing, shape (4, BALLS, 3)."""
    angles = 2.0 * math.pi * np.arange(BALLS) / balls + hidden.ball_errors
    return np.stack([angles, np.cos(angles), np.sin(angles)], axis=-1)


def document(p: Mapping[str, float], rolling: Rolling = Rolling()) -> dict[str, object]:
    """`machine.json`: what the engine is told, in the form that `sideband machine --from-reference` reads."""
    return {"parameters": dict(p), "bearings": [asdict(rolling)], "tolerance": SPREAD}
