"""Rotors as they are drawn, the arrays of their hidden copies, and the machine file the engine gets.

They move by the same compiled model as the gearboxes: its input shaft alone, the mesh and all torques taken out, weight
put in. The file is the machine specification's; its keys are all that is shared with `sim/`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from proof.machine import Arrays, Hidden, Rolling, arrays_of, spread_of
from proof.model.layout import B, G, X
from proof.nominals import Nominal

GRAVITY = 9.80665
DISC, SHAFT = "disc", "input"
NAMES = {"pinion": DISC}
"""Names in the machine file of what laws call the pinion."""
RESIDUAL = "em"
"""Whose hidden factor the residual unbalance has: teeth are not there to use it."""
RESIDUAL_AT_RAD = 0.4

ROTOR: Mapping[str, float] = {
    "If1": 0.01, "Ip": 0.02, "Ig": 0.01, "If2": 0.01, "mp_": 5.0, "mg": 3.0, "kf": 4e4, "cf": 5.0,
    "ks": 5e7, "cs": 700.0, "kp": 5e7, "cp": 2e3, "kr": 1.2e8, "cr": 400.0, "ms": 0.1, "mo": 0.15, "mr": 0.05,
    "kre": 9.33e9, "c0": 2e-6, "e0": 0.0, "em": 0.0, "phi": 0.0, "ct": 0.0, "T": 0.0, "z1": 20.0, "z2": 40.0,
    "m": 0.002, "W": 0.02, "al": 20.0, "fr1": 30.0, "u0": 1.5e-4,
}  # fmt: skip
"""Names and units of the gearboxes' `NOMINAL`, of which those of teeth stand for nothing; `u0`: residual unbalance,
kg m, that of ISO 21940-11's G 6.3 at 30 Hz for 5 kg."""


@dataclass(frozen=True, kw_only=True)
class Rotor(Nominal):
    """One rotor; `second`: the drawing of bearing2, `rolling` is that of bearing1."""

    second: Rolling

    def sound(self, hidden: Hidden, torque_nm: float = 0.0) -> Arrays:
        """The hidden rotor without any effect."""
        p = dict(self.parameters) | {"T": torque_nm}
        arrays = arrays_of(hidden, p, self.rolling)
        g, rollings = arrays.g, (self.rolling, self.second, self.rolling, self.rolling)
        g[G.KM] = g[G.TOUT] = g[G.E0] = g[G.EM] = g[G.CT] = 0.0
        g[G.GRAVITY] = GRAVITY
        for b, rolling in zip(arrays.bearings, rollings, strict=True):
            b[B.COUNT], b[B.PITCH] = rolling.balls, rolling.pitch_diameter_m
            b[B.RATIO] = rolling.ball_diameter_m / rolling.pitch_diameter_m
        arrays.x[X.UNBALANCE] = p["u0"] * hidden.factors.get(RESIDUAL, 1.0)
        arrays.x[X.UNBALANCE_PHASE] = RESIDUAL_AT_RAD
        spread = np.stack([spread_of(hidden, r.balls)[k] for k, r in enumerate(rollings)])
        return Arrays(g=g, bearings=arrays.bearings, mesh=arrays.mesh, x=arrays.x, teeth=arrays.teeth, spread=spread)

    def document(self, told: Mapping[str, float]) -> dict[str, object]:
        """`machine.json`: a machine specification."""
        bearings = [_bearing(f"bearing{k}", told, r) for k, r in enumerate((self.rolling, self.second), 1)]
        moment = {"moment": told["u0"], "phase": RESIDUAL_AT_RAD}
        return {
            "name": "rotor",
            "shafts": [{"name": SHAFT, "length_m": 0.3}],
            "bodies": [{"name": DISC, "mass_kg": told["mp_"], "shaft": SHAFT, "axes": "xy"}],
            "bearings": bearings,
            "resonators": [
                {
                    "name": f"resonator{k}", "bearing": f"bearing{k}", "mass_kg": told["mr"],
                    "stiffness_n_per_m": told["kr"], "damping_ns_per_m": told["cr"],
                }
                for k in (1, 2)
            ],
            "gravity_m_per_s2": GRAVITY,
            "operating": {"shaft": SHAFT, "speed_hz": self.speeds_hz[1], "rotation": "geared"},
            "terms": [{"term": "unbalance", "site": DISC, "parameters": moment}],
        }  # fmt: skip

    def named(self, site: str) -> str:
        """A site's name in the machine file."""
        return NAMES.get(site, site)


def _bearing(name: str, told: Mapping[str, float], rolling: Rolling) -> dict[str, object]:
    support = {f"stiffness_{a}_n_per_m": told["kp"] for a in "xy"} | {f"damping_{a}_ns_per_m": told["cp"] for a in "xy"}
    drawn = {
        "balls": rolling.balls,
        "ball_diameter_m": rolling.ball_diameter_m,
        "pitch_diameter_m": rolling.pitch_diameter_m,
    }
    return {
        "name": name, "body": DISC, "geometry": drawn, "contact_stiffness_n_per_m15": told["kre"],
        "radial_clearance_m": told["c0"], "inner_mass_kg": told["ms"], "outer_mass_kg": told["mo"],
        "shaft_stiffness_n_per_m": told["ks"], "shaft_damping_ns_per_m": told["cs"], "support": support,
    }  # fmt: skip


SMALL = Rolling(balls=9, pitch_diameter_m=0.03904, ball_diameter_m=0.00794)
ROTORS: Mapping[str, Rotor] = {
    "alike": Rotor(parameters=ROTOR, rolling=SMALL, second=SMALL, speeds_hz=(24.0, 30.0, 40.0)),
    "unlike": Rotor(
        parameters={
            **ROTOR, "mp_": 9.0, "ks": 1e8, "cs": 1.2e3, "kp": 1.1e8, "cp": 3e3, "mo": 0.3, "mr": 0.08, "kre": 8.5e9,
            "c0": 4e-6, "fr1": 25.0, "u0": 3.6e-4,
        },
        rolling=SMALL,
        second=Rolling(balls=8, pitch_diameter_m=0.046, ball_diameter_m=0.0095),
        speeds_hz=(20.0, 25.0, 33.0),
    ),
}  # fmt: skip
"""`alike`: two bearings of one drawing, 5 kg; `unlike`: two of different drawings, 9 kg, supports twice as stiff."""
