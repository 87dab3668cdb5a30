"""The way from a bearing's ring to the recorder, drawn widely: structure, fastening, noise, hum, filter, converter.

Ranges: resonances of housings and fastenings between 0.6 and 20 kHz, damping ratios of 0.8 to 8 % (Harris' Shock
and Vibration Handbook, 5th ed. 2002, ch. 12; Ewins, Modal Testing, 2nd ed. 2000); noise from 40 dB below to 26 dB above
the level that the background is drawn around, which noise, hum and range are multiples of.
"""

from __future__ import annotations

import math

RATES_HZ = (12_800.0, 20_000.0, 25_600.0, 48_000.0)
MODES = (2, 3, 5, 7)
BITS = (12, 16, 24)
LOWEST_MODE_HZ = 600.0
CHANNEL = "sensor"
LEAST_GAIN, GAIN, GAINS = 0.01, 0.5, 12


def log(low: float, high: float) -> dict[str, object]:
    """A range, even in its logarithm."""
    return {"low": low, "high": high, "scale": "log"}


def _gains() -> dict[str, object]:
    """Gains of a mode of either sign, evenly in their logarithm."""
    steps = [LEAST_GAIN * (GAIN / LEAST_GAIN) ** (k / (GAINS - 1)) for k in range(GAINS)]
    return {"choices": [round(sign * gain, 6) for sign in (-1, 1) for gain in steps]}


def drawn_chains(location: str) -> list[dict[str, object]]:
    """Chains of one accelerometer at `location`, as many as there are rates and numbers of modes."""
    kinds = [(rate, modes) for rate in RATES_HZ for modes in MODES]
    return [_chain(location, rate, modes, k) for k, (rate, modes) in enumerate(kinds)]


def _chain(location: str, rate_hz: float, modes: int, number: int) -> dict[str, object]:
    mode = {"frequency_hz": 1000.0, "damping_ratio": 0.03, "gain": 0.1}
    density = 1.0 / math.sqrt(rate_hz / 2)
    channel = {
        "kind": "accelerometer",
        "name": CHANNEL,
        "place": {"location": location, "direction_deg": 90.0},
        "path": {"kind": "modes", "direct": 0.3, "modes": [mode] * modes},
        "mounting": {"frequency_hz": 10_000.0, "damping_ratio": 0.05},
        "noise": {"density_per_sqrt_hz": density, "corner_hz": 100.0, "exponent": 1.0},
        "hum": {"mains_hz": 50.0, "amplitude": 0.1, "harmonics": [1.0, 0.5, 0.5, 0.25]},
        "anti_alias": {"cutoff_hz": 0.4 * rate_hz, "order": 4 + number % 5},
        "converter": {"bits": BITS[number % len(BITS)], "range_v": 300.0},
    }
    values: dict[str, object] = {
        "place.direction_deg": {"low": 30.0, "high": 150.0},
        "path.direct": log(0.03, 1.0),
        "mounting.frequency_hz": log(4e3, 30e3),
        "mounting.damping_ratio": log(0.03, 0.15),
        "noise.density_per_sqrt_hz": log(0.01 * density, 20.0 * density),
        "noise.corner_hz": log(1.0, 3e3),
        "noise.exponent": {"low": 0.5, "high": 1.5},
        "hum.mains_hz": {"choices": [50.0, 60.0]},
        "hum.amplitude": log(1e-3, 1.0),
        "anti_alias.cutoff_hz": {"low": 0.35 * rate_hz, "high": 0.45 * rate_hz},
        "converter.range_v": log(100.0, 1000.0),
    }
    for k in range(modes):
        values[f"path.modes.{k}.frequency_hz"] = log(LOWEST_MODE_HZ, 0.42 * rate_hz)
        values[f"path.modes.{k}.damping_ratio"] = log(0.008, 0.08)
        values[f"path.modes.{k}.gain"] = _gains()
    return {
        "name": f"chain{number}",
        "chain": {"clock": {"sampling_rate_hz": rate_hz}, "channels": [channel]},
        "vary": {f"channels.{CHANNEL}.{path}": value for path, value in values.items()},
    }


def bare_chain(location: str) -> list[dict[str, object]]:
    """An ideal accelerometer: the motion along y as it is."""
    channel = {"kind": "accelerometer", "name": CHANNEL, "place": {"location": location, "direction_deg": 90.0}}
    return [{"name": "bare", "chain": {"channels": [channel]}}]
