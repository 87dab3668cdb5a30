"""Indicators of one channel, asked for by kind: of a simulated result or of a recording."""

from jobs.indicators.documents import KINDS, IndicatorKind, indicators
from jobs.indicators.subject import Rotation, ShaftInfo, Subject, of_recording, of_result

__all__ = ["KINDS", "IndicatorKind", "Rotation", "ShaftInfo", "Subject", "indicators", "of_recording", "of_result"]
