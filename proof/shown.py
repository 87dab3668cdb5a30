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
    single = [s for s in scores if s.group == "single"]
    if not single or any(s.name not in seen for s in single):
        return []
    head = "| one effect, by how far it moves the spectrum | detected | named with place |"
    return _table(head, single, lambda s: _alone(seen[s.name]), lambda s: s.place)


def pair_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of pairs, how many are named rightly by how much there is to see of the fainter of the two beside the other."""
    pairs = [s for s in scores if s.group == "double"]
    if not pairs or any(s.name not in seen or not seen[s.name].parts_db for s in pairs):
        return []
    head = "| two effects, by how far the fainter moves what the other shows | detected | both named |"
    return _table(head, pairs, lambda s: _fainter(seen[s.name]), lambda s: s.both)


def open_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of effects that no library has, how many are told as unknown by how much there is to see of them."""
    unknown = [s for s in scores if s.group == "open"]
    if not unknown or any(s.name not in seen for s in unknown):
        return []
    head = "| an effect that no library has, by how far it moves the spectrum | detected | told as unknown |"
    return _table(head, unknown, lambda s: _alone(seen[s.name]), lambda s: s.unknown_flagged)


def all_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """The three tables of the cases of which what is to be seen was measured."""
    known = [s for s in scores if s.name in seen and (s.group != "double" or seen[s.name].parts_db)]
    return [*seen_rows(known, seen), *pair_rows(known, seen), *open_rows(known, seen)]


def _alone(one: Visible) -> float:
    return one.effect_db / max(one.drift_db, 1e-9)


def _fainter(one: Visible) -> float:
    return min(one.parts_db) / max(one.drift_db, 1e-9)


def _table(
    head: str, scores: Sequence[Score], far: Callable[[Score], float], right: Callable[[Score], bool | None]
) -> list[str]:
    rows = [head, "|---|---|---|"]
    for low, high, title in SEEN:
        part = [s for s in scores if low <= far(s) < high]
        told, named = sum(bool(s.alarm) for s in part), sum(bool(right(s)) for s in part)
        rows.append(f"| {title} | {told}/{len(part)} | {named}/{len(part)} |")
    return [*rows, ""]
