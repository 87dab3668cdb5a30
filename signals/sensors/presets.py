"""Sensors by name. What is not cited is a round figure typical of its kind, not the data of any product."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

G = 9.80665
"""Standard acceleration of gravity, m/s^2 (3rd CGPM, 1901)."""
MIL = 25.4e-6
"""Thousandth of an inch, m."""


@dataclass(frozen=True, kw_only=True)
class SensorPreset:
    """Values that a channel takes over where it does not say otherwise."""

    kind: str
    sentence: str
    source: str
    values: Mapping[str, object] = field(default_factory=dict)


GENERIC = "generic: round figures of its kind"

PRESETS: Mapping[str, SensorPreset] = {
    "icp-100mv-g": SensorPreset(
        kind="accelerometer",
        sentence="General purpose piezoelectric accelerometer with built-in amplifier, 100 mV/g, on a stud.",
        source=GENERIC,
        values={
            "sensor": {"sensitivity_v_per_unit": 0.1 / G, "lower_corner_hz": 0.2, "limit_v": 5.0},
            "mounting": {"frequency_hz": 30_000.0, "damping_ratio": 0.02},
            "noise": {"density_per_sqrt_hz": 5e-6 * G, "corner_hz": 30.0, "exponent": 1.0},
            "converter": {"bits": 24, "range_v": 10.0},
        },
    ),
    "icp-magnet": SensorPreset(
        kind="accelerometer",
        sentence="The same on a magnet: the fastening resonates in the band of bearing faults.",
        source=GENERIC,
        values={
            "sensor": {"sensitivity_v_per_unit": 0.1 / G, "lower_corner_hz": 0.2, "limit_v": 5.0},
            "mounting": {"frequency_hz": 7_000.0, "damping_ratio": 0.05},
            "noise": {"density_per_sqrt_hz": 5e-6 * G, "corner_hz": 30.0, "exponent": 1.0},
            "converter": {"bits": 24, "range_v": 10.0},
        },
    ),
    "mems-wideband": SensorPreset(
        kind="accelerometer",
        sentence="Capacitive wide-band accelerometer on its board: down to constant values, noisier than a piezo.",
        source="resonance of 42 kHz: ADXL1005 data sheet, rev. 0, p. 12 (Analog Devices); the rest " + GENERIC,
        values={
            "sensor": {"sensitivity_v_per_unit": 0.02 / G, "limit_v": 2.0},
            "mounting": {"frequency_hz": 42_000.0, "damping_ratio": 0.02},
            "noise": {"density_per_sqrt_hz": 1e-4 * G, "corner_hz": 0.1, "exponent": 1.0},
            "converter": {"bits": 16, "range_v": 2.5},
        },
    ),
    "velocity-coil": SensorPreset(
        kind="velocity",
        sentence="Moving coil with a seismic mass: 10 Hz lower corner, 20 mV per mm/s.",
        source=GENERIC,
        values={
            "sensor": {
                "sensitivity_v_per_unit": 20.0,
                "lower_corner_hz": 10.0,
                "lower_order": 2,
                "upper_corner_hz": 2e3,
            },
            "noise": {"density_per_sqrt_hz": 2e-8},
            "converter": {"bits": 24, "range_v": 10.0},
        },
    ),
    "proximity-8mm": SensorPreset(
        kind="proximity",
        sentence="Eddy-current probe of 8 mm: 200 mV/mil, 80 mil of linear range from 10 mil on, to 10 kHz.",
        source="scale factor 200 mV/mil: API Standard 670, 5th ed. (2014); range and corner " + GENERIC,
        values={
            "sensor": {"sensitivity_v_per_unit": 0.2 / MIL, "upper_corner_hz": 10_000.0},
            "probe": {"gap_m": 50 * MIL, "range_low_m": 10 * MIL, "range_high_m": 90 * MIL},
            "noise": {"density_per_sqrt_hz": 2e-9, "corner_hz": 1.0},
            "converter": {"bits": 24, "range_v": 24.0},
        },
    ),
    "torque-flange": SensorPreset(
        kind="torque",
        sentence="Strain gauges with telemetry: 20 mV/(N m), 1 kHz.",
        source=GENERIC,
        values={
            "sensor": {"sensitivity_v_per_unit": 0.02, "upper_corner_hz": 1000.0, "limit_v": 10.0},
            "noise": {"density_per_sqrt_hz": 1e-3},
            "converter": {"bits": 16, "range_v": 10.0},
        },
    ),
    "encoder-1024": SensorPreset(
        kind="tacho",
        sentence="Incremental encoder of 1024 pulses, timed by a counter of 80 MHz.",
        source=GENERIC,
        values={"pulser": {"pulses_per_revolution": 1024, "counter_hz": 8e7}},
    ),
    "once-per-turn": SensorPreset(
        kind="tacho",
        sentence="A mark and an optical probe, 2 us of jitter.",
        source=GENERIC,
        values={"pulser": {"pulses_per_revolution": 1, "duty": 0.1, "edge_jitter_rms_s": 2e-6}},
    ),
}
"""Every preset; a channel without one is ideal: unit sensitivity, no noise, no limits."""


def with_preset(data: Mapping[str, object], kind: str) -> dict[str, object]:
    """The channel's own values over those of its preset, whole stages at a time; ValueError for an unknown name.

    A stage given as null is left out.
    """
    name = data.get("preset")
    fitting = [key for key, preset in PRESETS.items() if preset.kind == kind]
    if not isinstance(name, str) or name not in fitting:
        raise ValueError(f"`preset` is not a known {kind}: {', '.join(fitting) or 'there is none'}")
    return {**PRESETS[name].values, **data}
