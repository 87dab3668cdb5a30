"""How long a reconciliation still takes, while machines are simulated for its atlas."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

LEAST_MADE = 0.02
"""Share of the engine's stages that must have been simulated before its pace says anything."""
KEPT_S = 0.2
"""A part that was there in less was kept from an earlier attempt: it took six of 68 parts for made ones, and told 0.6 s
of seven minutes."""
AFTERWARDS = 1.0 / 3.0
"""What follows the atlases takes about so much of what they took: a minute after three and a half of the preset
`bearing-rig`, 66 core-seconds (40 to 140) after 321 of the proof's gearbox at three speeds."""


@dataclass
class Pace:
    """Time per share, of parts that were simulated alone: an atlas that was there already says nothing."""

    begins: float
    """Share at which the atlases begin,"""
    ends: float
    """and end."""
    made: float = 0.0
    spent_s: float = 0.0
    _last: tuple[str, float, float] | None = field(default=None, repr=False)

    def left_s(self, stage: str, share: float) -> float | None:
        """Seconds from a part of a stage on; none where too little was simulated for its pace to say anything."""
        if share >= self.ends:
            after = (1.0 - share) / (1.0 - self.ends) * AFTERWARDS * (self.ends - self.begins)
            return self.spent_s / self.made * after if self.made >= LEAST_MADE else None
        now = time.monotonic()
        known = self._last is not None and self._last[0] == stage and share > self._last[1]
        if known and self._last is not None and now - self._last[2] >= KEPT_S:
            self.made += share - self._last[1]
            self.spent_s += now - self._last[2]
        if self._last is None or self._last[0] != stage or share > self._last[1]:
            self._last = (stage, share, now)
        if self.made < LEAST_MADE:
            return None
        return self.spent_s / self.made * (self.ends - share + AFTERWARDS * (self.ends - self.begins))
