"""Screens that are made for a decision."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.judge.screen import Screen

NAMES = (
    "outer_spall@bearing1",
    "outer_spall@bearing3",
    "inner_spall@bearing1",
    "tooth_crack@pinion",
    "unbalance@pinion",
    "unbalance@gear",
    "rub@pinion",
    "bent_shaft@pinion",
)


def screen(evidence: list[float], names: tuple[str, ...] = NAMES, **how: object) -> Screen:
    values = np.array(evidence + [-5.0] * (len(names) - len(evidence)))
    weights = np.exp(values - values.max())
    usual = {"p_any": 2e-4, "strongest": 40.0, "p_best": 2e-4, "p_direct": 1.0, "misfit": 0.4, "length": 90.0}
    return Screen(
        names=names,
        evidence=values,
        direct=np.zeros(len(names)),
        weights=weights / weights.sum(),
        by=np.zeros(len(names), dtype=int),
        **{**usual, **how},  # type: ignore[arg-type]
    )


def struck(evidence: list[float], direct: list[float], **how: object) -> Screen:
    made = screen(evidence, **how)
    shown = np.array(direct + [0.0] * (len(NAMES) - len(direct)))
    return replace(made, direct=shown)
