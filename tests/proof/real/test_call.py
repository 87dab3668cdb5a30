"""The engine is called on copies that tell nothing, and the page's head is the one the command writes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from proof.real import driven, page
from proof.real.__main__ import RECORDINGS, TIMEOUT_S
from proof.real.call import Source, _written
from proof.real.describe import index
from proof.real.rigs import KNOWN, PAIRS, WHY, stem
from proof.run import Engine

PAGE = Path(__file__).resolve().parents[3] / "docs" / "proof-real.md"
ENTRIES = {stem(e): e for e in index(RECORDINGS)["recordings"]} if RECORDINGS.is_dir() else {}
needs_recordings = pytest.mark.skipif(not ENTRIES, reason="the recordings are not beside the project")


def test_the_page_is_the_commands() -> None:
    text = PAGE.read_text(encoding="utf-8")
    ids = re.findall(r"`([0-9a-f]{12})`", text.partition("recordings, which")[0])
    assert text.startswith(page.HEAD.format(limit=TIMEOUT_S, kinematics=ids[0], driven=ids[1]))
    assert all(part in text for part in (page.SITES, page.PATHS, page.GAINS, page.DRIVEN, page.RIVALS))
    missed = [line.partition(" (")[0].removeprefix("- ") for line in text.splitlines() if "(wrong)" in line]
    assert set(missed) <= set(WHY)


@needs_recordings
def test_every_comparison_of_the_catalogue_is_run() -> None:
    files = {f for pair in PAIRS for f in pair} | {f for system in driven.SYSTEMS for f in system.files}
    offered = index(RECORDINGS)["pairs"]
    assert all(stem({"file": p["test"]}) in files for p in offered)
    assert files <= set(ENTRIES)
    assert {ENTRIES[test]["dataset"] for _, test in PAIRS} == set(KNOWN)


@needs_recordings
def test_columns_are_described_as_chosen(tmp_path: Path) -> None:
    system = driven.SYSTEMS[-1]
    assert system.columns is not None
    source = Source(entry=ENTRIES[system.files[1]], channels=system.columns[1])
    told = json.loads(_written(RECORDINGS, source, tmp_path, "test", 2).read_text())
    assert [(c["name"], c["column"], c["location"]) for c in told["channels"]] == [
        ("pump", "uVal", "input"),
        ("level", "yVal", "output"),
    ]
    assert "tank" not in json.dumps(told)


@pytest.mark.slow
@needs_recordings
def test_silverbox_by_the_command_line() -> None:
    """From the linear model to the cubic law; both directions of holding out below 1.1 %."""
    answer = driven.answered(Engine(timeout_s=TIMEOUT_S), RECORDINGS, ENTRIES, driven.SYSTEMS[0])
    assert answer.error is None
    assert driven.judged(driven.SYSTEMS[0], answer) == "right"
    assert answer.report is not None
    validations = [s for s in answer.report["stages"] if s.get("stage") == "validate"]
    assert [v["after"] < 0.011 for v in validations] == [True, True]
    assert all(v["before"] > 0.1 for v in validations)
    assert "cubic" in answer.report["sentence"]
    assert [(c["term"], c["named"]) for c in answer.report["causes"][:1]] == [("cubic_support", True)]
    assert answer.report["held_out"]["gain"] > answer.report["held_out"]["black_box"]
