"""Turning pydantic's findings into field problems; see `signals.validation`."""

from __future__ import annotations

from signals.validation import UNITS, Findings, problem_of, problems_of, shown, unit_of

__all__ = ["UNITS", "Findings", "problem_of", "problems_of", "shown", "unit_of"]
