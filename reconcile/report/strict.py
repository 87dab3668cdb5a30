"""From typed results to JSON as RFC 8259 has it: no NaN, no infinity, keys are text."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass

import numpy as np

from reconcile.report.revised import to_do
from reconcile.verdict import Report

Plain = None | bool | int | float | str | list["Plain"] | dict[str, "Plain"]
"""What JSON can say."""


def plain(value: object) -> Plain:  # noqa: PLR0911 - one line a kind of value
    """A value as JSON can say it; numbers that are none become null, anything unknown its text."""
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Iterable):
        return [plain(item) for item in value]
    return str(value)


def document(report: Report) -> dict[str, Plain]:
    """The report's keys as the interface names them, with plain values only; `to_do`: what a person can do now."""
    return {**{f.name: plain(getattr(report, f.name)) for f in fields(report)}, "to_do": to_do(report)}


def strict_json(report: Report) -> str:
    """The text of `report.json`."""
    return json.dumps(document(report), allow_nan=False, ensure_ascii=False, indent=1) + "\n"
