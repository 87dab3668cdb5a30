"""Tests that share what is dear to make run on one worker, and the longest come first."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.conftest import in_order


@pytest.mark.xdist_group("together")
def test_groups_have_an_effect(request: pytest.FixtureRequest) -> None:
    """Where tests are handed out by groups, the plugin's mark must reach the name by which it hands them out."""
    if by_groups(request):
        assert request.node.nodeid.endswith("@together")
    else:
        pytest.skip("tests are not handed out by groups here (`make test` does)")


def test_a_file_is_a_group_of_its_own(request: pytest.FixtureRequest) -> None:
    if by_groups(request):
        assert request.node.nodeid.endswith("@tests/house/test_groups.py")
    else:
        pytest.skip("tests are not handed out by groups here (`make test` does)")


def by_groups(request: pytest.FixtureRequest) -> bool:
    return bool(getattr(request.config.option, "loadgroup", False))


class Test:
    """A test as the hook sees it."""

    __test__ = False

    def __init__(self, name: str, file: str, *marks: pytest.MarkDecorator) -> None:
        self.name, self.path, self.marks = name, Path("/project") / file, list(marks)

    def get_closest_marker(self, name: str) -> pytest.Mark | None:
        return next((m.mark for m in self.marks if m.name == name), None)

    def add_marker(self, mark: pytest.MarkDecorator) -> None:
        self.marks.append(mark)


def test_files_stay_together_and_the_longest_come_first() -> None:
    slow, together = pytest.mark.slow, pytest.mark.xdist_group("shared")
    items = [
        Test("quick", "a.py"),
        Test("first", "b.py", slow),
        Test("apart", "b.py", slow, together),
        Test("second", "b.py"),
        Test("alone", "c.py", slow, pytest.mark.long),
        Test("too", "d.py", slow, together),
    ]
    for chosen, order in (
        (False, "quick first apart second alone too"),
        (True, "alone apart too first second quick"),
    ):
        config = SimpleNamespace(option=SimpleNamespace(loadgroup=chosen), rootpath=Path("/project"))
        in_order(config, items)  # type: ignore[arg-type]
        assert [item.name for item in items] == order.split()
    groups = {item.name: item.get_closest_marker("xdist_group").args[0] for item in items}  # type: ignore[union-attr]
    assert groups == {
        "quick": "a.py",
        "first": "b.py",
        "second": "b.py",
        "alone": "c.py",
        "apart": "shared",
        "too": "shared",
    }
