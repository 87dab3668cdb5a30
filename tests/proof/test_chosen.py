"""Cases are found by their names: of a split that is named, or of the one that has them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from proof import __main__ as commands
from proof.chosen import chosen, split_for
from proof.others import SPLITS, cases_of


def test_no_two_splits_have_a_name_in_common() -> None:
    names = [case.name for split in SPLITS for case in cases_of(split)]
    assert len(set(names)) == len(names)


def test_names_tell_their_split() -> None:
    for split in SPLITS:
        first, *_, last = (case.name for case in cases_of(split))
        assert split_for(None, f"{first},{last}") == split
    assert split_for(None, " s001 , s002,") == "sealed"


def test_a_split_that_is_named_stands() -> None:
    assert split_for("held", "s001") == "held"
    with pytest.raises(SystemExit, match=r"--cases: no such case in split held: s001"):
        chosen("held", "s001,h001")


@pytest.mark.parametrize(
    ("cases", "message"),
    [
        ("s001,x999", r"--cases: no such case in any split: x999"),
        ("h121", r"--cases: no such case in any split: h121"),
        ("s001,h001", r"--cases: these are of several splits, run one at a time: held, sealed"),
        ("3", r"--split: name one"),
        ("", r"--split: name one"),
        (",", r"--split: name one"),
    ],
)
def test_what_tells_no_split_is_refused_with_the_option_to_change(cases: str, message: str) -> None:
    with pytest.raises(SystemExit, match=message):
        split_for(None, cases)


def test_cases_are_those_named_the_first_so_many_or_all() -> None:
    assert [c.name for c in chosen("sealed", "s003,s001")] == ["s001", "s003"]
    assert [c.name for c in chosen("sealed", "2")] == ["s001", "s002"]
    assert chosen("sealed", "") == list(cases_of("sealed"))


def test_the_command_finds_the_split(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    monkeypatch.setattr(commands, "generate", lambda given: found.append((given.split, given.cases)))
    monkeypatch.setattr(sys, "argv", ["proof", "generate", "--cases", "s001"])
    commands.main()
    assert found == [("sealed", "s001")]


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        (("CASES=s001,s002",), '--cases "s001,s002"'),
        (("CASES=", "SPLIT="), '--split engraver --cases ""'),
        (("SPLIT=mixed", "CASES="), '--split mixed --cases ""'),
        (("SPLIT=mixed", "CASES=m001"), '--split mixed --cases "m001"'),
    ],
)
def test_the_door_stores_nothing_unasked_and_leaves_the_split_of_names_to_them(
    asked: tuple[str, ...], told: str
) -> None:
    outside = {k: v for k, v in os.environ.items() if k not in {"SPLIT", "CASES", "KEEP"} and "MAKE" not in k}
    root = Path(commands.__file__).parents[1]
    said = subprocess.run(
        ["make", "-n", "proof", *asked], cwd=root, env=outside, capture_output=True, text=True, check=False
    )
    lines = [" ".join(line.split()) for line in said.stdout.splitlines() if " -m proof" in line]
    assert [line.split()[3] for line in lines] == ["generate", "run", "score"], said.stderr
    assert all(told in line for line in lines) and ("--split" in told) == ("--split" in lines[0])
    assert "--keep" not in said.stdout and "-m proof page" not in said.stdout
