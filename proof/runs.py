"""Stored summaries as runs: of which split, by which engine, and whether no engine had met the cases before."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from proof.plan import Split
from proof.said import SECTIONS
from proof.score.one import Score
from proof.whole import read


@dataclass(frozen=True, kw_only=True)
class Run:
    """One stored summary. `first`: no engine had met its cases before, as stored with it; `commit`: of its engine."""

    section: str
    split: str
    engine: str
    commit: str | None
    first: bool
    scores: tuple[Score, ...]

    @property
    def by(self) -> str:
        """The engine in words."""
        return f"`{self.engine}`" + (f" (commit {self.commit})" if self.commit else "")


def every_run(results: Path) -> list[Run]:
    """All that are stored, in the order of the page."""
    return [_run(section, path) for section in SECTIONS if (path := results / f"{section}.json").exists()]


def runs_of(results: Path, split: Split) -> list[Run]:
    """All that are stored of a split, in the order of the page."""
    return [run for run in every_run(results) if run.split == split]


def met(runs: Iterable[Run]) -> list[Score]:
    """The scores of first runs together, each case once."""
    return list({s.name: s for run in runs if run.first for s in run.scores}.values())


def _run(section: str, path: Path) -> Run:
    document = json.loads(path.read_text(encoding="utf-8"))
    return Run(
        section=section,
        split=str(document.get("split")),
        engine=str(document.get("engine", "unknown")),
        commit=document.get("commit"),
        first=document.get("first_run") is True,
        scores=tuple(read(path)),
    )
