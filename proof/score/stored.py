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
