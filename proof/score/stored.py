"""Scores that a stored summary holds: a split may be run in parts, whose reports are not kept together."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from proof.score.one import Score


class OtherRun(ValueError):
    """A stored summary is of another split or engine."""


def together(path: Path, split: str, engine: str, scores: Sequence[Score]) -> list[Score]:
    """The scores of the summary at `path` and `scores`, by name; OtherRun unless it is of this split and engine.

    A case of both counts as it was stored: its first run stands.
    """
    document = json.loads(path.read_text(encoding="utf-8"))
    if (document["split"], document["engine"]) != (split, engine):
        message = (
            f"{path.name} is of split {document['split']} by engine {document['engine']}, not of {split}, {engine}"
        )
        raise OtherRun(message)
    names = {field.name for field in fields(Score)}
    found = {s.name: s for s in scores}
    for stored in document["scores"]:
        values: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in stored.items() if k in names}
        one = Score(**values)
        found[one.name] = one
    return [found[name] for name in sorted(found)]


LIKE = 0.02
"""By which numbers may differ between machines."""
NOT_ASKED = ("core_seconds",)


def compared(path: Path, engine: str, scores: Sequence[Score]) -> list[str]:
    """How scores stand to those of the summary at `path`: a line that counts, and one for each case that differs."""
    document = json.loads(path.read_text(encoding="utf-8"))
    stored = {row["name"]: row for row in document["scores"]}
    both = [s for s in scores if s.name in stored]
    unlike = {s.name: differing for s in both if (differing := _differing(s, stored[s.name]))}
    same = "the same engine" if document["engine"] == engine else f"engine {document['engine']}, here {engine}"
    head = f"{len(both) - len(unlike)} of {len(both)} as stored in {path.name} ({same})"
    return [head, *(f"{name} is not: {', '.join(words)}" for name, words in unlike.items())]


def other_verdicts(path: Path, scores: Sequence[Score]) -> list[str]:
    """Of the cases that the summary at `path` holds, those whose verdict is another: name, what was stored, and now."""
    stored = {row["name"]: row["verdict"] for row in json.loads(path.read_text(encoding="utf-8"))["scores"]}
    differ = [s for s in scores if stored.get(s.name, s.verdict) != s.verdict]
    return [f"{s.name} ({stored[s.name]} was stored, now {s.verdict})" for s in differ]


def _differing(score: Score, stored: dict[str, Any]) -> list[str]:
    words = []
    for field in fields(Score):
        now, was = getattr(score, field.name), stored.get(field.name)
        if isinstance(was, list):
            was = tuple(was)
        if field.name not in NOT_ASKED and field.name in stored and not _alike(now, was):
            words.append(f"{field.name} {was} was stored, now {now}")
    return words


def _alike(now: object, was: object) -> bool:
    if isinstance(now, float) and isinstance(was, float | int) and not isinstance(was, bool):
        return abs(now - was) <= LIKE * max(abs(was), LIKE)
    return now == was
