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
