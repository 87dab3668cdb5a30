"""What `make test` leaves out is there, and of its file another test runs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.conftest import FURTHER, pytest_collection_modifyitems

LISTED = FURTHER.read_text(encoding="utf-8").splitlines()
ROOT = FURTHER.parent.parent


def test_every_line_is_a_test_of_its_file() -> None:
    missing = []
    for line in LISTED:
        file, name = line.split("::", 1)
        source = ROOT / file
        function = re.escape(name.split("[")[0].split("::")[-1])
        if not source.exists() or not re.search(rf"^\s*def {function}\(", source.read_text(encoding="utf-8"), re.M):
            missing.append(line)
    assert not missing


def test_lines_are_sorted_and_come_once() -> None:
    assert sorted(set(LISTED)) == LISTED


class Item:
    """A test as the hook sees it."""

    __test__ = False

    def __init__(self, nodeid: str) -> None:
        self.nodeid = nodeid
        self.path = Path(nodeid.split("::", maxsplit=1)[0])

    def add_marker(self, _mark: pytest.MarkDecorator) -> None:
        return None


def collected(args: Sequence[str] = ("tests",), markexpr: str = "", keyword: str = "") -> tuple[int, int]:
    """How many are run of two, one of which is listed, and how many are told as left out."""
    told: list[object] = []

    def left_out(*, items: Sequence[object]) -> None:
        told.extend(items)

    config = SimpleNamespace(
        args=list(args),
        option=SimpleNamespace(markexpr=markexpr, keyword=keyword),
        hook=SimpleNamespace(pytest_deselected=left_out),
    )
    items = [Item(LISTED[0]), Item(f"{LISTED[0].split('[', maxsplit=1)[0]}[another]")]
    pytest_collection_modifyitems(config, items)  # type: ignore[arg-type]
    return len(items), len(told)


def test_they_run_only_when_asked_for() -> None:
    assert collected() == (1, 1)
    assert collected(markexpr="not slow") == (1, 1)
    assert collected(markexpr="further") == (2, 0)
    assert collected(args=[LISTED[0]]) == (2, 0)
    assert collected(keyword="any") == (2, 0)


def test_a_list_that_leaves_no_test_of_a_file_is_refused() -> None:
    config = SimpleNamespace(args=["tests"], option=SimpleNamespace(markexpr="", keyword=""))
    with pytest.raises(pytest.UsageError, match="leaves no test of tests/"):
        pytest_collection_modifyitems(config, [Item(LISTED[0])])  # type: ignore[arg-type, list-item]
