"""The worked example of docs/reconcile.md, as it stands there."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from app.cli.main import main

PAGE = Path(__file__).resolve().parents[3] / "docs" / "reconcile.md"


@pytest.mark.slow
def test_the_driven_mass_answers_as_the_page_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = PAGE.read_text(encoding="utf-8").split("### A driven mass, from end to end")[1].split("\n### ")[0]
    machine, description, script, command, answer = re.findall(r"```\w*\n(.*?)```", text, re.S)
    monkeypatch.chdir(tmp_path)
    Path("one_mass.json").write_text(machine, encoding="utf-8")
    Path("shaker.json").write_text(description, encoding="utf-8")
    subprocess.run([sys.executable, "-c", script], check=True)
    assert main(command.split()[1:]) == 0
    said = capsys.readouterr().out
    figures = re.compile(r"\d+(?:\.\d+)?")
    assert figures.sub("#", answer.strip()) in figures.sub("#", said), said
    force = json.loads(Path("report/report.json").read_text(encoding="utf-8"))["force"]
    assert force["coefficients"]["cubic"] == pytest.approx(4.02e10, rel=0.02)
