"""What the README says of the proof is what the stored first runs give."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from proof.engine_id import engine_id
from proof.one_engine import CLEAR
from proof.score.one import Score
from proof.score.rates import MEASURES, Rate, at_target, rate
from proof.targets import wrong_rates
from proof.visible import stored as stored_visible
from proof.whole import read

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
FIRST, LATEST, SEEN = ("engraver",), ("engraver",), ("engraver",)
"""The sections of the first row, of the latest plan that was run to its end, and of the one of which is stored how far
effects move the spectrum."""
ROWS = {
    "b8750338": FIRST,
    "5ceca0e6": ("dyer",),
    "29caa8f7": ("chandler",),
    "3adfd5e2": ("baker",),
    "65e82a62": ("twelfth",),
    "a60fa3d9": ("xenial",),
    "337a1755": ("zenith", "after"),
}
"""The commit with which a row begins, and the sections it is of."""
EARLIER = (
    "inquest", "jury", "clear", "vast", "young", "mixed", "resumed", "last", "closing", "wide", "teeth", "held",
    "begun", "hearing", "entire",
)  # fmt: skip
"""Sections of the twelve plans that have one row."""
COLUMNS = (("single", "place"), ("double", "both"), ("open", "unknown_flagged"), ("null", "alarm"))


def stored(sections: Sequence[str]) -> list[Score]:
    return [s for name in sections for s in read(ROOT / "proof" / "results" / f"{name}.json")]


def of(scores: Sequence[Score], group: str, measure: str) -> Rate:
    return rate([s for s in scores if s.group == group and at_target(s)], MEASURES[measure])


def plain(found: Rate) -> str:
    return f"{found.hits} of {found.n}" if found.n else "-"


@pytest.mark.parametrize("commit", ROWS)
def test_a_row_of_the_table(commit: str) -> None:
    (row,) = re.findall(rf"^\| {commit}\b.*$", README, flags=re.MULTILINE)
    cells = [re.sub(r" \(.*\)", "", cell.strip()) for cell in row.strip("|").split("|")]
    found = stored(ROWS[commit])
    said = [plain(of(found, *column)) for column in COLUMNS]
    assert cells[1:] == [*said, plain(wrong_rates(found)[-1])]
    low, high = of(found, "single", "place").interval
    assert f"{100 * low:.0f} to {100 * high:.0f})" in row


def test_the_first_row_is_of_the_engine_at_hand_only_while_it_is() -> None:
    """An engine that has changed since answers otherwise: then the README must not say so."""
    (run,) = [json.loads((ROOT / "proof" / "results" / f"{name}.json").read_text("utf-8"))["engine"] for name in FIRST]
    assert ("The first row is of the version you have here" in README) == (run == engine_id())


def test_the_row_of_twelve_plans() -> None:
    (row,) = re.findall(r"^\| twelve earlier plans together\b.*$", README, flags=re.MULTILINE)
    cells = [re.sub(r" \(.*\)", "", cell.strip()) for cell in row.strip("|").split("|")]
    found = stored(EARLIER)
    assert cells[1:] == [*(plain(of(found, *column)) for column in COLUMNS), plain(wrong_rates(found)[-1])]


def test_what_is_said_of_the_latest_whole_plan() -> None:
    found = stored(LATEST)
    single = of(found, "single", "alarm")
    right = of(found, "single", "verdict_right")
    first = f"Of b8750338's {single.n} single faults {single.hits} were detected. {right.hits} were answered rightly"
    assert first in " ".join(README.split())
    nulls, sound = of(found, "null", "alarm"), of(found, "null", "told_sound")
    other = [s for s in found if s.group == "null" and not at_target(s)]
    alarmed = {0: "none", 1: "one", 2: "two"}[sum(s.alarm for s in other)]
    said = f"Of its {nulls.n} sound machines {sound.hits} were told sound; of three under other conditions {alarmed} al"
    assert len(other) == 3 and said in " ".join(README.split())


def test_what_is_said_of_sizes() -> None:
    found = stored(LATEST)
    off = [s.severity_error for s in found if s.severity_error is not None]
    named = [s.severity_error for s in found if s.severity_error is not None and s.place]
    half, worst, few, most = (100 * float(np.quantile(k, share)) for k in (off, named) for share in (0.5, 0.9))
    first = f"b8750338's cases at all conditions {len(off)} true effects got a size, {len(named)} of them by name"
    own = f"{first}: of these half are within {few:.0f} %, one in ten is off by {most:.0f} % or more"
    said = f"{own}; of all {len(off)} half are within {half:.0f} %, one in ten is off by {worst:.0f} % or more."
    assert said in " ".join(README.split())
    held = [s.severity_covered for s in found if s.severity_covered is not None]
    assert f"Of {len(held)} intervals {sum(held)} held the truth" in " ".join(README.split())


def test_what_is_said_of_what_shows() -> None:
    seen = stored_visible(ROOT / "proof" / "results" / "visible-engraver.json")
    single = [s for s in stored(SEEN) if s.group == "single" and at_target(s)]
    clear = [s for s in single if seen[s.name].effect_db >= CLEAR * seen[s.name].drift_db]
    named, others = (sum(bool(s.place) for s in part) for part in (clear, [s for s in single if s not in clear]))
    said = f"Of b8750338's {len(single)} single faults {len(clear)} change the spectrum at least three times as much"
    told = f"{named} of these were named, of the other {len(single) - len(clear)} {others or 'none'}"
    assert said in " ".join(README.split()) and told in " ".join(README.split())


def test_what_is_said_of_the_version_before() -> None:
    found = stored(("present",))
    single, nulls, names = of(found, "single", "place"), of(found, "null", "alarm"), wrong_rates(found)[-1]
    said = (
        f"it names {single.hits} of {single.n} single faults with their place, alarms on {nulls.hits} of {nulls.n} "
        f"sound machines, and {names.hits} of its {names.n} names are wrong"
    )
    assert len(found) == 72 and said in " ".join(README.split())
