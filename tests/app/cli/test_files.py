"""Files of the command line: what JSON may hold, told with the file and the field."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.files import json_text, read_json
from sim.core.errors import SpecError


def test_half_a_character_is_refused_with_file_and_field(tmp_path: Path) -> None:
    path = tmp_path / "m.json"
    path.write_text(json.dumps({"bodies": [{"name": "a\ud800"}]}), encoding="utf-8")
    with pytest.raises(SpecError) as refused:
        read_json(path)
    (problem,) = refused.value.problems
    assert problem.field == f"{path}: bodies.0.name" and problem.given == "a\\ud800"
    path.write_text(json.dumps({"name": "a😀"}), encoding="utf-8")
    assert "a😀" in json_text(read_json(path))
