"""The page: sections of what is stored, and figures of the text that come from it."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from proof import page
from proof.method import METHOD
from proof.page import write_page
from proof.said import SECTIONS

HERE = Path(page.__file__).parent
WIDEST = 120


@pytest.mark.slow
def test_the_page_at_hand_is_that_of_the_stored_scores(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "draw", lambda _summary, _path: None)
    written = write_page(tmp_path, HERE / "results").read_text(encoding="utf-8")
    assert written == (HERE.parent / "docs" / "proof.md").read_text(encoding="utf-8")
    for section in SECTIONS:
        assert (f"\n## {section.capitalize()}: " in written) == (HERE / "results" / f"{section}.json").exists()


def test_lines_of_the_text_are_filled_and_no_wider_than_the_page() -> None:
    blocks = [b.splitlines() for b in METHOD.split("\n\n") if not b.startswith(("|", "#", "{"))]
    assert max(len(line) for lines in blocks for line in lines) <= WIDEST
    broken = [
        line
        for lines in blocks
        for line, after in pairwise(lines)
        if "{" not in line and not after.startswith("* ") and len(line) + 1 + len(after.split()[0]) <= WIDEST - 25
    ]
    assert not broken, "lines that end early"
