"""What a score is, in a line under the table of candidates: by level and unit."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.verdict import Cause, Level

SCORE = (
    "Score: how much better the recordings are foretold with the effect than with nothing missing, as a logarithm; a "
    "lead of 3 is twenty times the odds."
)
DEVIATIONS, DECIBELS = "deviations", "dB"
LOG_EVIDENCE, LOG_GROWTH = "log evidence", "log growth"
BY_UNIT = {
    DEVIATIONS: "Score: by how many robust deviations what was heard stands above what orders of no part, or the "
    "baseline, show; shared out where several places have the same lines; that of a damaged ball is of what its reason "
    "says. A name needs 5 or more. It ranks the candidates and is no probability.",
    DECIBELS: "Score: by how many decibels the lines grew over the baseline. It ranks the candidates and is no "
    "probability.",
    LOG_EVIDENCE: "Score: how rare such a burst at one place of the turn is on gears with sound teeth, as a logarithm; "
    "3 is one in twenty.",
    LOG_GROWTH: "Score: how many times what comes back with each turn grew, as a logarithm; 1 is 2.7 times.",
}
"""At level `kinematics`, by `Cause.score_unit`."""


def score_notes(causes: Sequence[Cause], level: Level) -> list[str]:
    """What the scores of these candidates are: one line, or one for each unit."""
    if level != "kinematics":
        return [SCORE]
    return [BY_UNIT[unit] for unit in dict.fromkeys(c.score_unit for c in causes) if unit in BY_UNIT]
