"""What is done with the answers of a run: held against the stored ones, or stored where no evidence is lost by it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from proof.plan import Split
from proof.runs import runs_of
from proof.score.one import Score
from proof.score.rates import summary
from proof.score.stored import OtherRun, compared, other_verdicts, together


@dataclass(frozen=True, kw_only=True)
class Answers:
    """Scores of cases of a split by one engine. `first`: no engine had met them before; `commit`: of that engine."""

    split: Split
    engine: str
    scores: tuple[Score, ...]
    first: bool = False
    commit: str | None = None

    def document(self) -> dict[str, Any]:
        """As it is stored."""
        commit = {"commit": self.commit} if self.commit else {}
        scores = [asdict(s) for s in self.scores]
        return {
            "split": self.split, "engine": self.engine, "first_run": self.first, **commit, **summary(self.scores),
            "scores": scores,
        }  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Compared:
    """How answers stand to the stored ones: lines that say it, and the cases whose verdict is another."""

    lines: tuple[str, ...]
    others: tuple[str, ...]


def against(results: Path, answers: Answers, section: str | None = None) -> Compared:
    """Answers case by case against those stored: each against its run by the same engine where there is one, else its
    first run, else another; or all those that `section` has."""
    left = {s.name: s for s in answers.scores}
    lines: list[str] = []
    others: list[str] = []
    alike = 0
    for run in sorted(runs_of(results, answers.split), key=lambda run: (run.engine != answers.engine, not run.first)):
        if section not in {None, run.section}:
            continue
        part = [left.pop(s.name) for s in run.scores if s.name in left]
        if part:
            path = results / f"{run.section}.json"
            told = compared(path, answers.engine, part)
            lines += told
            others += other_verdicts(path, part)
            alike += len(part) - (len(told) - 1)
    stored = len(answers.scores) - len(left)
    lines.append(f"{alike} of {stored} answers are the same as stored; nothing was stored or replaced")
    if left:
        lines.append(f"{len(left)} have no stored answer: {', '.join(left)}")
    return Compared(lines=tuple(lines), others=tuple(others))


def keep(results: Path, section: str, answers: Answers, *, add: bool = False) -> Answers:
    """Store answers as a section's summary, with `add` beside those in it; OtherRun where it would lose or claim
    something."""
    path = results / f"{section}.json"
    old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else None
    if old is not None:
        _refuse_loss(path, old, answers, add=add)
        _refuse_mixture(path, old, answers, add=add)
    if answers.first:
        _refuse_claim(results, section, answers)
    whole = Answers(
        split=answers.split,
        engine=answers.engine,
        scores=tuple(together(path, answers.split, answers.engine, answers.scores)) if old and add else answers.scores,
        first=answers.first or bool(old and old.get("first_run")),
        commit=answers.commit or (old or {}).get("commit"),
    )
    results.mkdir(exist_ok=True)
    path.write_text(json.dumps(whole.document(), sort_keys=True, indent=1) + "\n", encoding="utf-8")
    return whole


def _refuse_loss(path: Path, old: dict[str, Any], answers: Answers, *, add: bool) -> None:
    """OtherRun where what another engine answered would be replaced, or cases dropped."""
    if (old["split"], old["engine"]) != (answers.split, answers.engine):
        message = (
            f"{path.name} holds the answers of engine {old['engine']} to {len(old['scores'])} cases of split "
            f"{old['split']}, which cannot be had again from engine {answers.engine} (split {answers.split}): "
            "keep these under another --name"
        )
        raise OtherRun(message)
    lost = sorted({row["name"] for row in old["scores"]} - {s.name for s in answers.scores})
    if lost and not add:
        message = f"{path.name} holds cases that are not among these ({', '.join(lost)}): --add keeps both"
        raise OtherRun(message)


def _refuse_mixture(path: Path, old: dict[str, Any], answers: Answers, *, add: bool) -> None:
    """OtherRun where first runs and others would stand in one summary."""
    new = sorted({s.name for s in answers.scores} - {row["name"] for row in old["scores"]})
    firsts = bool(old.get("first_run"))
    if firsts and new and not answers.first:
        message = f"{path.name} holds first runs alone: add --first-run if no engine had met {', '.join(new)}"
        raise OtherRun(message)
    if answers.first and add and not firsts:
        message = f"{path.name} holds cases that are not known to be first runs: keep these under another --name"
        raise OtherRun(message)


def _refuse_claim(results: Path, section: str, answers: Answers) -> None:
    """OtherRun where cases are said to be met for the first time and are stored elsewhere, or no commit is named."""
    if not answers.commit:
        message = "--first-run: name the engine's commit too (--commit), or nobody can make the run again"
        raise OtherRun(message)
    for run in runs_of(results, answers.split):
        again = sorted({s.name for s in answers.scores} & {s.name for s in run.scores})
        if again and run.section != section:
            message = f"--first-run: {run.section}.json holds answers to {', '.join(again)} already"
            raise OtherRun(message)
