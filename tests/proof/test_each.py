"""What is measured of each case is stored after every one."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import pytest

from proof.each import of_each
from proof.others import cases_of


@pytest.mark.slow
def test_what_is_stored_stays_and_the_rest_is_added_by_name(tmp_path: Path) -> None:
    first, second, third = cases_of("wide")[:3]
    store = tmp_path / "copies.json"
    found = of_each([third, first], copy.copy, {second.name: second}, store, 1)
    assert found == {c.name: c for c in (first, second, third)}
    kept = json.loads(store.read_text(encoding="utf-8"))
    assert list(kept) == sorted(kept) == sorted(found) and kept[third.name]["seed"] == third.seed
