"""The nominal machines that cases are made of: the paper's, and others of its kind with other numbers throughout."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from proof.machine import NOMINAL, Arrays, Hidden, Rolling, arrays_of, document

PAPER = "paper"


@dataclass(frozen=True, kw_only=True)
class Nominal:
    """One machine as it is drawn: parameters (names and units of `machine.NOMINAL`), bearings, three stated speeds."""

    parameters: Mapping[str, float]
    rolling: Rolling
    speeds_hz: tuple[float, ...]

    def sound(self, hidden: Hidden, torque_nm: float) -> Arrays:
        """A hidden copy without any effect."""
        return arrays_of(hidden, dict(self.parameters) | {"T": torque_nm}, self.rolling)

    def document(self, told: Mapping[str, float]) -> dict[str, object]:
        """`machine.json` with these parameters."""
        return document(told, self.rolling)

    def named(self, site: str) -> str:
        """A site's name in `machine.json`."""
        return site


NOMINALS: Mapping[str, Nominal] = {
    PAPER: Nominal(parameters=NOMINAL, rolling=Rolling(), speeds_hz=(22.5, 30.0, 39.0)),
    "stiff": Nominal(
        parameters={
            **NOMINAL, "z1": 29.0, "z2": 67.0, "W": 0.03, "fr1": 24.0, "T": 40.0, "Ip": 9e-4, "Ig": 5.5e-3, "mp_": 1.5,
            "mg": 2.5, "kf": 7e4, "ks": 1.1e8, "kp": 1.1e8, "cs": 2.4e3, "cp": 2.4e3, "kre": 7e9, "em": 1.2e-5,
            "ct": 1900.0,
        },
        rolling=Rolling(balls=9, pitch_diameter_m=0.03904, ball_diameter_m=0.00794),
        speeds_hz=(18.0, 24.0, 31.0),
    ),
    "soft": Nominal(
        parameters={
            **NOMINAL, "z1": 19.0, "z2": 64.0, "m": 0.0025, "W": 0.02, "fr1": 38.0, "T": 18.0, "If1": 0.003,
            "ks": 4e7, "kp": 3.6e7, "cs": 2.5e3, "cp": 3.2e3, "kr": 1.8e8, "kre": 9e9, "c0": 4e-6, "em": 1.5e-5,
        },
        rolling=Rolling(balls=8, pitch_diameter_m=0.046, ball_diameter_m=0.0095),
        speeds_hz=(29.0, 38.0, 46.0),
    ),
    "fine": Nominal(
        parameters={
            **NOMINAL, "z1": 31.0, "z2": 53.0, "m": 0.0015, "W": 0.018, "fr1": 21.0, "T": 12.0, "Ip": 3e-4,
            "Ig": 2e-3, "If2": 0.006, "mp_": 0.8, "mg": 1.6, "kf": 2.5e4, "ks": 5.2e7, "kp": 9e7, "kr": 3.2e8,
            "mr": 0.35, "kre": 6e9, "e0": 2e-5, "em": 8e-6, "ct": 900.0,
        },
        rolling=Rolling(balls=11, pitch_diameter_m=0.04, ball_diameter_m=0.00635),
        speeds_hz=(20.0, 25.0, 33.0),
    ),
}  # fmt: skip
"""`stiff`: 1.7 times the supports, nine balls, a wider mesh; `soft`: half of the supports, more damped, faster, coarser
teeth; `fine`: a module of 1.5 mm, eleven small balls, a light load."""
KINDS: Mapping[str, Nominal] = {
    "even": Nominal(
        parameters={
            **NOMINAL, "z1": 37.0, "z2": 41.0, "W": 0.022, "fr1": 22.0, "T": 30.0, "If1": 0.0035, "Ip": 1.6e-3,
            "Ig": 2.3e-3, "If2": 0.0042, "mp_": 1.7, "mg": 1.95, "kf": 3.2e4, "ks": 8.2e7, "kp": 5.4e7, "cs": 2e3,
            "cp": 2.6e3, "kr": 3.6e8, "ms": 0.55, "mr": 0.6, "kre": 7.5e9, "c0": 3e-6, "e0": 2.2e-5, "em": 1e-5,
            "ct": 1700.0,
        },
        rolling=Rolling(balls=10, pitch_diameter_m=0.0435, ball_diameter_m=0.0079),
        speeds_hz=(17.0, 22.0, 28.0),
    ),
    "coarse": Nominal(
        parameters={
            **NOMINAL, "z1": 21.0, "z2": 71.0, "m": 0.003, "W": 0.035, "fr1": 34.0, "T": 60.0, "If1": 0.004,
            "Ip": 9e-4, "Ig": 1.5e-2, "If2": 0.016, "mp_": 1.6, "mg": 5.2, "kf": 8e4, "cf": 8.0, "ks": 1.4e8,
            "kp": 1.2e8, "cs": 3.4e3, "cp": 3.4e3, "kr": 4.2e8, "cr": 2.4e3, "ms": 0.8, "mo": 0.2, "mr": 0.9,
            "kre": 1e10, "e0": 3e-5, "em": 1.4e-5, "ct": 2400.0,
        },
        rolling=Rolling(balls=12, pitch_diameter_m=0.062, ball_diameter_m=0.0111),
        speeds_hz=(26.0, 34.0, 43.0),
    ),
}  # fmt: skip
"""Of the split `kinds`. `even`: shafts that turn nearly alike, ten balls; `coarse`: heavy, stiff and loaded, a module
of 3 mm, twelve balls."""
