"""How often the engine was right by how much there was to see, which nobody knows who has the recordings alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from textwrap import wrap

from proof.score.one import Score
from proof.visible import Visible

SEEN = (
    (0.0, 1.0, "less than drift alone does"),
    (1.0, 3.0, "one to three times as far as drift"),
    (3.0, float("inf"), "more than three times as far"),
)
"""Ranges of effect over drift, both in dB."""
WIDTH = 120
"""Of the page's lines."""


def seen_rows(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """Of single effects, how many are named with their place by how much there is to see of them; empty where that
    is stored of none."""
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
    """The three tables, each of every case of its group."""
    return [*seen_rows(scores, seen), *pair_rows(scores, seen), *open_rows(scores, seen)]


def parting(scores: Sequence[Score], seen: Mapping[str, Visible]) -> list[str]:
    """How well two measures of what there is to see part single effects that were told from those that were not."""
    part = [(s, seen[s.name]) for s in scores if s.group == "single" and s.name in seen]
    measures: tuple[Callable[[Visible], float], ...] = (_over_drift, lambda one: one.new_share)
    marks: tuple[tuple[str, Callable[[Score], bool | None]], ...] = (
        ("detected single effect lies above an undetected one", lambda s: s.alarm),
        ("named one above an unnamed one", lambda s: s.place),
    )
    told = []
    for words, right in marks:
        good, bad = [one for s, one in part if right(s)], [one for s, one in part if not right(s)]
        if good and bad:
            far, new = (100 * _above([f(one) for one in good], [f(one) for one in bad]) for f in measures)
            told.append(f"a {words} in {far:.0f} % of all couples ({new:.0f} % by the share of new bins)")
    text = f"By this measure {', '.join(told)}."
    return wrap(text, WIDTH) if told else []


def _above(first: Sequence[float], second: Sequence[float]) -> float:
    """Chance that one of the first is above one of the second (Mann and Whitney 1947, Ann. Math. Stat. 18, 50-60)."""
    return sum((a > b) + 0.5 * (a == b) for a in first for b in second) / (len(first) * len(second))


def _ratio(score: Score, seen: Mapping[str, Visible]) -> float | None:
    """Effect over drift, of a pair that of the fainter beside the other; None where it was not measured."""
    one = seen.get(score.name)
    if one is None or (score.group == "double" and not one.parts_db):
        return None
    return _over_drift(one)


def _over_drift(one: Visible) -> float:
    return min(one.parts_db, default=one.effect_db) / max(one.drift_db, 1e-9)


def _table(
    group: str,
    words: tuple[str, str],
    scores: Sequence[Score],
    seen: Mapping[str, Visible],
    right: Callable[[Score], bool | None],
) -> list[str]:
    part = [(s, _ratio(s, seen)) for s in scores if s.group == group]
    if all(far is None for _, far in part):
        return []
    rows = [f"| {words[0]} | detected | {words[1]} |", "|---|---|---|"]
    parts = [(title, [s for s, far in part if far is not None and low <= far < high]) for low, high, title in SEEN]
    if unknown := [s for s, far in part if far is None]:
        parts.append(("not measured", unknown))
    for title, here in [*parts, ("all", [s for s, _ in part])]:
        told, named = sum(bool(s.alarm) for s in here), sum(bool(right(s)) for s in here)
        rows.append(f"| {title} | {told}/{len(here)} | {named}/{len(here)} |")
    return [*rows, ""]
