"""Features in words, with their units."""

from __future__ import annotations

from jobs.health.words import BEARING_KINDS

NAMES = {
    "rms": "RMS about the mean",
    "peak": "Peak about the mean",
    "crest_factor": "Crest factor",
    "kurtosis": "Kurtosis",
    "velocity_rms": "RMS velocity, 10 Hz to 1 kHz",
}
FAMILIES = {
    "shaft": "shaft (first 3 harmonics, RMS)",
    "mesh": "mesh (first 3 harmonics, RMS)",
    "outer": "outer race (f_o of the envelope)",
    "inner": "inner race (f_i of the envelope)",
    "ball": "balls (f_b of the envelope)",
    "cage": "cage (f_c of the envelope)",
}
OCTAVE = "octave."
DIMENSIONLESS = ("crest_factor", "kurtosis")


def is_family(feature: str) -> bool:
    """Whether it follows lines of a part."""
    return feature not in NAMES and not feature.startswith(OCTAVE)


def title_of(feature: str) -> str:
    """`bearing1 outer race (f_o of the envelope)`."""
    if feature.startswith(OCTAVE):
        return f"Octave at {feature.removeprefix(OCTAVE)} Hz, RMS"
    if feature in NAMES:
        return NAMES[feature]
    site, _, kind = feature.rpartition(".")
    return f"{site}: {FAMILIES.get(kind, kind)}"


def unit_of(feature: str, channel_unit: str) -> str:
    """`1` for what has none."""
    if feature in DIMENSIONLESS or (is_family(feature) and feature.rpartition(".")[2] in BEARING_KINDS):
        return "1"
    return "m/s" if feature == "velocity_rms" else channel_unit
