"""What is asked of the engine at the target condition, and how rates stand against it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from proof.score.one import Score
from proof.score.rates import Rate, at_target

HALF = 0.5
BAR_S = 120.0
"""Core-seconds that a case may take."""


class Stands(NamedTuple):
    """Whether a target is met, and by how much it is missed or how surely it is held."""

    met: bool
    words: str

    def text(self) -> str:
        """As a cell of the table."""
        return f"held{self.words and ', '}{self.words}" if self.met else f"missed {self.words}"


@dataclass(frozen=True, kw_only=True)
class Target:
    """A measure of a group, in words, and the shares between which it is to lie; both None: told, with no target."""

    group: str
    measure: str
    words: str
    least: float | None = None
    most: float | None = None

    def standing(self, found: Rate) -> Stands | None:
        """Against the target; None where there is none or nothing was counted."""
        if found.n == 0 or (self.least is None and self.most is None):
            return None
        low, high = self.least or 0.0, 1.0 if self.most is None else self.most
        least, most = found.interval
        short = max(low - found.share, found.share - high)
        if short > 0.0:
            beyond = "" if most < low or least > high else ", within the interval"
            return Stands(False, f"by {100 * short:.{0 if short >= ROUND else 1}f} points{beyond}")
        return Stands(True, "" if least >= low and most <= high else "though the interval reaches beyond")


ROUND = 0.02
"""From which share on whole points are told."""
TARGETS = (
    Target(group="null", measure="alarm", words="false alarms on nulls at most 8/300", most=8 / 300),
    Target(group="null", measure="told_sound", words='of these told "nothing missing", others "not decidable"'),
    Target(group="single", measure="mechanism", words="mechanism right at least 95 %", least=0.95),
    Target(group="single", measure="place", words="with place at least 85 %", least=0.85),
    Target(group="single", measure="top_three", words="among the first three at least 97 %", least=0.97),
    Target(group="open", measure="unknown_flagged", words="unknown effects flagged at least 80 %", least=0.8),
    Target(group="single", measure="false_unknown", words="false unknowns, of single effects, at most 5 %", most=0.05),
    Target(group="double", measure="both", words="both of a pair at least 70 %", least=0.7),
    Target(group="double", measure="false_name", words="a name beside the pair's"),
    Target(group="single", measure="severity_covered", words="90 % intervals cover 85-95 %", least=0.85, most=0.95),
    Target(group="single", measure="beats_black_box", words="beats the black box in at least 80 %", least=0.8),
    Target(
        group="single",
        measure="placebo_improves",
        words="placebos (the median of each case's) improve in at most 5 %",
        most=0.05,
    ),
    Target(group="ambiguous", measure="cannot_tell", words='"cannot tell" in at least 90 % of look-alikes', least=0.9),
    Target(group="ambiguous", measure="as_a_set", words='of these told as a set, others "not decidable"'),
)
SEVERITY = (("median", 0.1, "severity error, median at most 0.1"), ("p90", 0.3, "its 90th percentile at most 0.3"))
"""Quantile of the sizes' relative errors, the most it may be, in words."""
CUT_WORDS = (
    "spectral distance cut by at least 50 %, of all",
    "spectral distance cut by at least 50 %, of those detected where drift and noise leave room for it",
)
SOUND = ("null", "misset", "sensor")
"""Groups in which no effect is hidden."""
WRONG_WORDS = (
    "one effect named as another or elsewhere",
    "a name where no effect is hidden",
    "a name for an effect that no library has",
    "wrong among all names given (of a pair: one that is not there)",
)


def cut_rates(scores: Sequence[Score]) -> tuple[Rate, Rate]:
    """How often the spectral distance is cut by half: of all single effects, undetected ones too, and of those of which
    a gain was measured and drift and noise let one expect as much."""
    single = [s for s in scores if s.group == "single"]
    room = [s for s in single if s.gain is not None and s.ceiling is not None and s.ceiling >= HALF]
    first, second = (
        Rate(hits=sum(s.gain is not None and s.gain >= HALF for s in part), n=len(part)) for part in (single, room)
    )
    return first, second


def wrong_rates(scores: Sequence[Score]) -> tuple[Rate, ...]:
    """Names given to single effects that are wrong in kind or place, to machines where nothing is hidden, and to
    effects that no library has; and how many of all names given are wrong."""
    groups = (("single",), SOUND, ("open",))
    found = [[s for s in scores if s.group in several] for several in groups]
    named = [s for s in scores if s.verdict == "explained"]
    return (
        *(Rate(hits=sum(map(_misnamed, part)), n=len(part)) for part in found),
        Rate(hits=sum(map(_misnamed, named)), n=len(named)),
    )


def _misnamed(score: Score) -> bool:
    if score.verdict != "explained":
        return False
    if score.group in (*SOUND, "open"):
        return True
    return bool(score.false_name) if score.group == "double" else score.place is False


def cut_rows(scores: Sequence[Score]) -> list[str]:
    """Of a section's table, at the target condition."""
    found = cut_rates([s for s in scores if at_target(s)])
    return [f"| {words} | {written(r)} |" for words, r in zip(CUT_WORDS, found, strict=True)]


def wrong_rows(scores: Sequence[Score]) -> list[str]:
    """Of a section's table."""
    return [f"| {words} | {written(r)} |" for words, r in zip(WRONG_WORDS, wrong_rates(scores), strict=True)]


def written(found: Rate) -> str:
    """A rate with its interval, or a dash where nothing was counted."""
    return quoted(found.document()) if found.n else "-"


def quoted(found: Mapping[str, float]) -> str:
    """The same of a stored rate."""
    share = 100 * found["hits"] / found["n"]
    return f"{found['hits']}/{found['n']} = {share:.0f} % ({100 * found['low']:.0f} to {100 * found['high']:.0f})"
