"""Names that the parts of a machine's health share."""

from __future__ import annotations

from typing import Literal

CONDITION = "condition"
"""Name of the document with a recording's features, kept beside its samples."""
CONDITION_VERSION = "condition-1"
"""Features of different versions are not compared."""
MOST_SAMPLES = 2**21
"""Of each channel: the beginning of a longer recording stands for it."""

Severity = Literal["measurement", "warning", "alarm"]
"""From mild to grave; `measurement` speaks of the sensor, not of the machine."""
State = Literal["unknown", "ok", "measurement", "warning", "alarm"]
"""`unknown`: nothing to judge by. The worst is last."""
STATES: tuple[State, ...] = ("unknown", "ok", "measurement", "warning", "alarm")
AlarmKind = Literal["level", "family", "limit", "measurement"]
BEARING_KINDS = ("outer", "inner", "ball", "cage")
