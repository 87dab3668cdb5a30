"""Rules on rows of numbers. Pure functions; every threshold has a name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from scipy.stats import spearmanr

Verdict = Literal["reproduced", "partly", "not"]
CLEAR_RANK = 0.9
"""Spearman rank correlation from which a row counts as rising throughout."""
SOME_RANK = 0.5
LEAST_CHANGE = 0.05
"""Net change over the row (relative to its larger end) below which nothing is said to change."""
MOST = 0.8
"""Share of the cases that must agree for `reproduced`."""


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """Verdict on one part of a trend and the numbers it rests on."""

    verdict: Verdict
    numbers: str


def rank(values: Sequence[float]) -> float:
    """Spearman correlation of a row with its index; 0 for a constant row."""
    if max(values) == min(values):
        return 0.0
    return float(spearmanr(range(len(values)), values).statistic)


def change(values: Sequence[float]) -> float:
    """Net change from the first to the last, relative to the larger of the two."""
    scale = max(abs(values[0]), abs(values[-1]))
    return (values[-1] - values[0]) / scale if scale > 0 else 0.0


def rises(values: Sequence[float], *, least: float = LEAST_CHANGE) -> Verdict:
    """`reproduced`: ends higher and rises nearly throughout; `partly`: ends higher, or rises mostly."""
    up = change(values) > least
    if up and rank(values) >= CLEAR_RANK:
        return "reproduced"
    return "partly" if up or (rank(values) >= SOME_RANK and change(values) > 0) else "not"


def falls(values: Sequence[float], *, least: float = LEAST_CHANGE) -> Verdict:
    """As `rises`, downwards."""
    return rises([-v for v in values], least=least)


def share(agreeing: Sequence[bool]) -> Verdict:
    """`reproduced` when at least 80 % of the cases agree, `partly` when any does."""
    part = sum(agreeing) / len(agreeing)
    return "reproduced" if part >= MOST else "partly" if part > 0 else "not"


def count(found: float, wanted: int) -> Verdict:
    """`reproduced` when all wanted are found, `partly` when at least half."""
    if found >= wanted:
        return "reproduced"
    return "partly" if found >= 0.5 * wanted else "not"


def both(first: Verdict, second: Verdict) -> Verdict:
    """The weaker of two; `partly` when exactly one of them fails."""
    if first == second:
        return first
    return "partly"


def shown(values: Sequence[float], scale: float = 1.0, digits: int = 3) -> str:
    """A row of numbers for a table."""
    return ", ".join(f"{v * scale:.{digits}g}" for v in values)
