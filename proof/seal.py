"""Seals: salted hashes of the truths, committed before the engine runs, so that no label can change afterwards.

A seal proves that a truth was not edited. It does not hide it: who has the code and the seed can make the case again.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from proof.case import canonical, truth_of
from proof.plan import SEEDS, Case, Split

FOLDER = Path(__file__).parent / "seals"


def salt(case: Case) -> str:
    """Salt of a case, hex: without it short labels could be guessed from their hashes."""
    return hmac.new(str(case.seed).encode(), case.name.encode(), hashlib.sha256).hexdigest()[:32]


def sealed(case: Case, truth: str) -> str:
    """Hash of a truth as it stands in its file."""
    return hashlib.sha256((salt(case) + truth).encode()).hexdigest()


def manifest(split: Split, cases: Iterable[Case]) -> dict[str, object]:
    """The hashes of all cases of a split."""
    found = {case.name: sealed(case, canonical(truth_of(case))) for case in cases}
    return {"split": split, "plan_seed": SEEDS[split], "sha256": found}


def write_manifest(split: Split, cases: Iterable[Case]) -> Path:
    """Write `seals/<split>.json`."""
    path = FOLDER / f"{split}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(canonical(manifest(split, cases)), encoding="utf-8")
    return path


def broken(cases: Iterable[Case], truths: Path, seals: Mapping[str, str]) -> list[str]:
    """Names of the cases whose truth is not the one that was sealed (or was never sealed)."""
    return [
        case.name
        for case in cases
        if sealed(case, (truths / f"{case.name}.json").read_text(encoding="utf-8")) != seals.get(case.name)
    ]


def seals_of(split: Split) -> dict[str, str]:
    """The committed hashes by case."""
    found: dict[str, str] = json.loads((FOLDER / f"{split}.json").read_text(encoding="utf-8"))["sha256"]
    return found
