"""Findings of request models as field problems: `signals.validation`, under the name the doors know."""

from __future__ import annotations

from signals.validation import UNITS, Findings, problem_of, problems_of, several_of, shown, unit_of

__all__ = ["UNITS", "Findings", "problem_of", "problems_of", "several_of", "shown", "unit_of"]
