"""The snippet of docs/signals.md runs as it stands."""

from __future__ import annotations

import re
from pathlib import Path

import pytest


@pytest.mark.slow
def test_the_snippet_of_the_page_runs() -> None:
    page = (Path(__file__).parents[2] / "docs" / "signals.md").read_text(encoding="utf-8")
    code = next(text for text in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "label_peaks" in text)
    names: dict[str, object] = {}
    exec(code, names)
    assert names["labels"]["1*f_m-1*f_r1"].status == "present"  # type: ignore[index]
