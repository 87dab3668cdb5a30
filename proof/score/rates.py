"""Rates with intervals, over groups and along severity, noise and sensors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from proof.score.one import Score

Z90 = 1.6448536269514722
Measure = Callable[[Score], bool | None]


@dataclass(frozen=True, kw_only=True)
class Rate:
    """`hits` of `n`, and Wilson's 90 % interval."""

    hits: int
    n: int

    @property
    def share(self) -> float:
        """hits / n."""
        return self.hits / self.n if self.n else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson, J. Am. Stat. Assoc. 22 (1927) 209."""
        return wilson(self.hits, self.n)

    def text(self) -> str:
        """As `12/14 86 % (65-95)`."""
        if not self.n:
            return "-"
        low, high = self.interval
        return f"{self.hits}/{self.n} {100 * self.share:.0f} % ({100 * low:.0f}-{100 * high:.0f})"

    def document(self) -> dict[str, float | int]:
        """JSON."""
        low, high = self.interval
        return {"hits": self.hits, "n": self.n, "low": low, "high": high}


def wilson(hits: int, n: int, z: float = Z90) -> tuple[float, float]:
    """Score interval of a proportion."""
    if n == 0:
        return 0.0, 1.0
    p = hits / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, middle - half), min(1.0, middle + half)


def rate(scores: Iterable[Score], measure: Measure) -> Rate:
    """How often the measure holds among the cases it applies to."""
    found = [value for value in map(measure, scores) if value is not None]
    return Rate(hits=sum(found), n=len(found))


MEASURES: dict[str, Measure] = {
    "failed": lambda s: s.failed,
    "alarm": lambda s: s.alarm,
    "verdict_right": lambda s: s.verdict_right,
    "mechanism": lambda s: s.mechanism,
    "place": lambda s: s.place,
    "top_three": lambda s: s.top_three,
    "both": lambda s: s.both,
    "unknown_flagged": lambda s: s.unknown_flagged,
    "false_unknown": lambda s: s.false_unknown,
    "false_name": lambda s: s.false_name,
    "cannot_tell": lambda s: s.cannot_tell,
    "as_a_set": lambda s: None if s.cannot_tell is None else s.cannot_tell and s.verdict == "ambiguous",
    "told_sound": lambda s: s.verdict == "nothing_missing" if s.group == "null" else None,
    "fault_kind": lambda s: s.fault_kind,
    "fault_channel": lambda s: s.fault_channel,
    "severity_covered": lambda s: s.severity_covered,
    "beats_retuned": lambda s: s.beats_retuned,
    "beats_black_box": lambda s: s.beats_black_box,
    "placebo_improves": lambda s: s.placebo_improves,
    "gain_above_half": lambda s: None if s.gain is None else s.gain >= 0.5,
}


def at_target(s: Score) -> bool:
    """3 sensors, baseline, 20 dB, 3 speeds: the condition of the stated targets."""
    return (s.sensors, s.snr_db, s.speeds, s.baseline) == (3, 20.0, 3, True)


def group_rates(scores: Sequence[Score]) -> dict[str, dict[str, Rate]]:
    """Every measure by group, where it applies."""
    groups = dict.fromkeys(s.group for s in scores)
    table = {g: {m: rate([s for s in scores if s.group == g], f) for m, f in MEASURES.items()} for g in sorted(groups)}
    return {g: {m: r for m, r in row.items() if r.n} for g, row in table.items()}


def curve(scores: Iterable[Score], axis: Callable[[Score], float], measure: str) -> dict[float, Rate]:
    """A measure of single effects along an axis."""
    single = [s for s in scores if s.group == "single"]
    return {v: rate([s for s in single if axis(s) == v], MEASURES[measure]) for v in sorted({axis(s) for s in single})}


def law_rates(scores: Iterable[Score], measure: str) -> dict[str, Rate]:
    """A measure of single effects by law."""
    single = [s for s in scores if s.group in {"single", "open"}]
    laws = sorted({s.laws[0] for s in single})
    return {law: rate([s for s in single if s.laws[0] == law], MEASURES[measure]) for law in laws}


def quantiles(values: Iterable[float | None]) -> dict[str, float]:
    """Median and 90th percentile of what there is."""
    found = [v for v in values if v is not None]
    if not found:
        return {"n": 0}
    return {"n": len(found), "median": float(np.median(found)), "p90": float(np.quantile(found, 0.9))}


def summary(scores: Sequence[Score]) -> dict[str, object]:
    """Everything the page shows, as JSON."""
    target = [s for s in scores if at_target(s)]
    pages = {"all": scores, "target": target}
    axes: dict[str, Callable[[Score], float]] = {
        "level": lambda s: s.level,
        "snr_db": lambda s: s.snr_db,
        "sensors": lambda s: s.sensors,
        "speeds": lambda s: s.speeds,
    }
    return {
        "cases": len(scores),
        "groups": {
            name: {g: {m: r.document() for m, r in row.items()} for g, row in group_rates(part).items()}
            for name, part in pages.items()
        },
        "curves": {
            axis: {
                m: {str(v): r.document() for v, r in curve(scores, f, m).items()}
                for m in ("alarm", "mechanism", "place")
            }
            for axis, f in axes.items()
        },
        "laws": {m: {law: r.document() for law, r in law_rates(scores, m).items()} for m in ("alarm", "verdict_right")},
        "severity_error": quantiles(s.severity_error for s in scores),
        "gain": quantiles(s.gain for s in scores),
        "ceiling": quantiles(s.ceiling for s in scores),
        "core_seconds": quantiles(s.core_seconds for s in scores),
    }
