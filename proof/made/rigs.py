"""Rigs at random: shafts, teeth, bearings, sensors, paths and noise; the drawing as a user would describe it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
KINDS = ("motor", "gearbox")
RATES_HZ = (12_000.0, 20_000.0, 25_600.0, 48_000.0)
SECONDS = (1.5, 3.0, 6.0, 10.0)
MOST_SAMPLES = 320_000
WANDER = (3e-4, 1e-3, 3e-3)
"""Of the speed, root mean square."""
JITTER = (0.002, 0.008, 0.015)
"""Of the distance from one ball to the next."""
LABEL = 0.01
"""By which the stated speed is off at most."""
MODES = 3
LINES = 4


@dataclass(frozen=True, kw_only=True)
class Bearing:
    """Sizes of one bearing, on the shaft `shaft` (its number)."""

    name: str
    shaft: int
    balls: int
    ratio: float

    @property
    def outer(self) -> float:
        """Balls that pass the outer race a turn."""
        return self.balls * (1 - self.ratio) / 2

    @property
    def inner(self) -> float:
        """Balls that pass the inner race a turn."""
        return self.balls * (1 + self.ratio) / 2

    @property
    def ball(self) -> float:
        """Times a spot of a ball meets a race, a turn."""
        return (1 - self.ratio**2) / self.ratio

    @property
    def cage(self) -> float:
        """Turns of the cage a turn."""
        return (1 - self.ratio) / 2


@dataclass(frozen=True, kw_only=True)
class Rig:
    """`teeth`: of each stage, pinion and wheel; `modes` (sensors, bearings, MODES, 3): frequency over the sampling
    rate, damping ratio, gain; `mesh` (sensors, stages, LINES), `shaft` (sensors, LINES): amplitudes of lines."""

    rate_hz: float
    seconds: float
    speed_hz: float
    teeth: tuple[tuple[int, int], ...]
    bearings: tuple[Bearing, ...]
    modes: FloatArray
    mesh: FloatArray
    shaft: FloatArray
    runout: FloatArray
    wander: float
    jitter: float
    noise: float
    supply: float

    @property
    def shafts(self) -> tuple[str, ...]:
        """Names, the driven one first."""
        return (*("input", "middle")[: len(self.teeth)], "output") if self.teeth else ("rotor",)

    @property
    def sensors(self) -> int:
        """Their number."""
        return int(self.modes.shape[0])

    def drawing(self) -> dict[str, Any]:
        """What `reconcile --machine` takes."""
        names = self.shafts
        gears = [
            {"name": f"{word}{k}", "shaft": names[k - 1 + side], "teeth": pair[side]}
            for k, pair in enumerate(self.teeth, 1)
            for side, word in enumerate(("pinion", "wheel"))
        ]
        meshes = [{"name": f"mesh{k}", "gears": [f"pinion{k}", f"wheel{k}"]} for k in range(1, len(self.teeth) + 1)]
        bearings = [
            {"name": b.name, "shaft": names[b.shaft], "balls": b.balls, "diameter_ratio": b.ratio}
            for b in self.bearings
        ]
        shafts: list[dict[str, Any]] = [{"name": n} for n in names]
        shafts[0]["speed_hz"] = self.speed_hz
        return {"kinematics": {"shafts": shafts, "bearings": bearings, "gears": gears, "meshes": meshes}}


def bearing(k: int, shaft: int, *, balls: int, ratio: float) -> Bearing:
    """The bearing with no more balls than its pitch circle has room for, a hundredth of it between them."""
    most = int(0.99 * np.pi / np.arcsin(ratio))
    return Bearing(name=f"bearing{k}", shaft=shaft, balls=min(balls, most), ratio=ratio)


def rig(kind: str, rng: np.random.Generator) -> Rig:
    """A motor with two bearings, or a gearbox of one or two stages with one a shaft."""
    geared = kind == "gearbox"
    rate = float(rng.choice(RATES_HZ))
    speed = float(rng.uniform(10, 30) if geared else rng.uniform(12, 50))
    seconds = min(max(float(rng.choice(SECONDS[geared:])), 30 / speed), MOST_SAMPLES / rate)
    stages = int(rng.integers(1, 3)) if geared else 0
    teeth = tuple((int(rng.integers(17, 32)), int(rng.integers(40, 90))) for _ in range(stages))
    sensors = int(rng.integers(1 + geared, 4))
    places = range(stages + 1) if geared else (0, 0)
    bearings = tuple(
        bearing(k, shaft, balls=int(rng.integers(7, 13)), ratio=round(rng.uniform(0.16, 0.26), 4))
        for k, shaft in enumerate(places, 1)
    )
    modes = np.stack(
        [
            rng.uniform(0.06, 0.36, (sensors, len(bearings), MODES)),
            rng.uniform(0.015, 0.06, (sensors, len(bearings), MODES)),
            rng.uniform(0.3, 1.0, (sensors, len(bearings), MODES)),
        ],
        axis=-1,
    )
    apart = (np.arange(sensors)[:, None] + np.arange(len(bearings))) % 2 == 1
    modes[..., 2] *= np.where(apart, 0.35, 1.0)[..., None]
    falling = 1.0 / np.arange(1, LINES + 1)
    return Rig(
        rate_hz=rate,
        seconds=seconds,
        speed_hz=round(speed, 2),
        teeth=teeth,
        bearings=bearings,
        modes=modes,
        mesh=rng.uniform(0.3, 1.5, (sensors, stages, LINES)) * falling,
        shaft=rng.uniform(0.05, 0.3 if geared else 1.0, (sensors, LINES)) * falling,
        runout=rng.uniform(0.01, 0.08, (max(stages, 1), 2)),
        wander=float(rng.choice(WANDER)),
        jitter=float(rng.choice(JITTER)),
        noise=float(rng.uniform(0.1, 0.4)),
        supply=0.0 if geared else float(rng.uniform(0.0, 0.2)),
    )
