"""Indicators of one channel, asked for by kind: of a simulated result or of a recording."""

from jobs.indicators.bounds import Stretch, check_bounds, usual_alpha_hz
from jobs.indicators.documents import KINDS, IndicatorKind, indicators
from jobs.indicators.subject import Rotation, ShaftInfo, Subject, bases_of, of_recording, of_result, stretch_of

__all__ = [
    "KINDS",
    "IndicatorKind",
    "Rotation",
    "ShaftInfo",
    "Stretch",
    "Subject",
    "bases_of",
    "check_bounds",
    "indicators",
    "of_recording",
    "of_result",
    "stretch_of",
    "usual_alpha_hz",
]
