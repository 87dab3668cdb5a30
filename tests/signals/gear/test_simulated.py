"""Indicators of simulated gearboxes follow the severity of the fault, and its place."""

from __future__ import annotations

from functools import cache

import pytest

from signals.gear import GearIndicators, gear_indicators
from signals.overrides import apply_overrides
from signals.recording import from_response
from signals.synchronous import SynchronousAverage, synchronous_average
from sim.presets import preset
from sim.solve.api import simulate
from sim.terms import REGISTRY

PINION_TEETH, PINION_HZ = 23, 30.0


@cache
def mean_turn(key: str = "", value: float = 0.0, ratio: float = 1.0) -> SynchronousAverage:
    """Mean of 20 turns of the pinion's shaft (or of one that turns `ratio` times as fast) of the paper's gearbox."""
    machine = preset("paper")
    if key:
        machine = apply_overrides(machine, {key: value})
    response = simulate(machine, duration_s=1.0, output_rate_hz=30_000.0)
    recording = from_response(response).select(start_s=0.3)
    series = recording.series(next(c.name for c in recording.channels if c.quantity == "acceleration"))
    return synchronous_average(series, shaft="f_r1", rotation=PINION_HZ, ratio=ratio, max_revolutions=20)


def course(key: str, values: tuple[float, ...]) -> list[GearIndicators]:
    """Indicators over rising severity; the healthy machine is the earlier run."""
    return [gear_indicators(mean_turn(key, v), teeth=[PINION_TEETH], earlier=[mean_turn()]) for v in values]


@pytest.mark.slow
def test_pitch_error_raises_the_residual_and_na4() -> None:
    """Of two runs NA4 cannot exceed 2^2 times the kurtosis: a residual that dwarfs the healthy one reaches that."""
    found = course("pitch_error@pinion.rms", (2e-9, 2e-8, 2e-7, 2e-6))
    rms = [f.residual.rms for f in found]
    assert rms == sorted(rms) and rms[3] > 50 * rms[0]
    shares = [f.na4 / f.residual.kurtosis for f in found if f.na4 is not None and f.residual.kurtosis is not None]
    assert len(shares) == 4 and shares == sorted(shares)
    assert shares[0] < 2 and shares[3] == pytest.approx(4, rel=0.01)


@pytest.mark.slow
@pytest.mark.skipif(REGISTRY.get("tooth_crack") is None, reason="no term for a tooth crack in the registry")
def test_a_tooth_crack_raises_fm4_and_na4() -> None:
    found = course("tooth_crack@pinion.depth", (0.05, 0.1, 0.2, 0.35, 0.5))
    for name in ("fm4", "m6a", "m8a", "na4", "nb4"):
        values = [getattr(f, name) for f in found]
        assert values == sorted(values) and values[-1] > 3 * values[0], (name, values)
    assert found[-1].fm4 is not None and found[-1].fm4 > 15, "one tooth of 23 stands out"


@pytest.mark.slow
@pytest.mark.skipif(REGISTRY.get("tooth_crack") is None, reason="no term for a tooth crack in the registry")
def test_the_crack_is_seen_at_its_own_shaft() -> None:
    """In the mean turn of the other shaft the cracked tooth comes at 81 places: nothing stands out."""
    cracked = mean_turn("tooth_crack@pinion.depth", 0.5, ratio=23 / 81)
    own = gear_indicators(mean_turn("tooth_crack@pinion.depth", 0.5), teeth=[PINION_TEETH])
    other = gear_indicators(cracked, teeth=[81])
    assert own.fm4 is not None and other.fm4 is not None
    assert own.fm4 > 15 and other.fm4 < 4
