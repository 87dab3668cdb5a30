"""How often the engine was right by how much there was to see, which nobody knows who has the recordings alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from proof.score.one import Score
from proof.visible import Visible

SEEN = (
    (0.0, 1.0, "less than drift alone does"),
    (1.0, 3.0, "one to three times as far as drift"),
    (3.0, float("inf"), "more than three times as far"),
)
"""Ranges of effect over drift, both in dB."""


def seen_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of single effects, how many are named with their place by how much there is to see of them; empty where that is
    not stored of all."""
    words = "one effect, by how far it moves the spectrum", "named with place"
    return _table("single", words, scores, seen, lambda s: s.place)


def pair_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of pairs, how many are named rightly by how much there is to see of the fainter of the two beside the other."""
    words = "two effects, by how far the fainter moves what the other shows", "both named"
    return _table("double", words, scores, seen, lambda s: s.both)


def open_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of effects that no library has, how many are told as unknown by how much there is to see of them."""
    words = "an effect that no library has, by how far it moves the spectrum", "told as unknown"
    return _table("open", words, scores, seen, lambda s: s.unknown_flagged)


def all_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """The three tables of the cases of which what is to be seen was measured."""
    known = [s for s in scores if _ratio(s, seen) is not None]
    return [*seen_rows(known, seen), *pair_rows(known, seen), *open_rows(known, seen)]


def _ratio(score: Score, seen: Mapping[str, Visible]) -> float | None:
    """Effect over drift, of a pair that of the fainter beside the other; None where it was not measured."""
    one = seen.get(score.name)
    if one is None or (score.group == "double" and not one.parts_db):
        return None
    return (min(one.parts_db) if score.group == "double" else one.effect_db) / max(one.drift_db, 1e-9)


def _table(
    group: str,
    words: tuple[str, str],
    scores: Sequence[Score],
    seen: Mapping[str, Visible],
    right: Callable[[Score], bool | None],
) -> list[str]:
    part = [(s, _ratio(s, seen)) for s in scores if s.group == group]
    if not part or any(far is None for _, far in part):
        return []
    rows = [f"| {words[0]} | detected | {words[1]} |", "|---|---|---|"]
    for low, high, title in SEEN:
        here = [s for s, far in part if far is not None and low <= far < high]
        told, named = sum(bool(s.alarm) for s in here), sum(bool(right(s)) for s in here)
        rows.append(f"| {title} | {told}/{len(here)} | {named}/{len(here)} |")
    return [*rows, ""]
