"""Colours of maps: a diverging scale for signed values, readable on light and dark ground."""

from __future__ import annotations

import math

COLD, MIDDLE, WARM = (33, 102, 172), (247, 247, 247), (178, 24, 43)


def diverging(share: float) -> str:
    """-1 is blue, 0 near white, 1 red; beyond that the ends."""
    share = min(max(share, -1.0), 1.0)
    end = WARM if share >= 0 else COLD
    weight = math.sqrt(abs(share))
    mixed = [round(m + (e - m) * weight) for m, e in zip(MIDDLE, end, strict=True)]
    return "#{:02x}{:02x}{:02x}".format(*mixed)
