"""The page says what an oracle tells of the single effects that the engine did not name."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

from proof.limit import limit
from proof.oracle import HALF, Seen, store_of, stored
from proof.others import cases_of
from proof.score.rates import at_target
from proof.whole import read

RESULTS = Path(__file__).parents[2] / "proof" / "results"


def kept(folder: Path, bounds: list[tuple[float, float]], places: list[bool]) -> list[str]:
    """So many single effects of `held` at the target condition with these answers and bounds; their names."""
    singles = [s for s in read(RESULTS / "held.json") if s.group == "single" and at_target(s)][: len(places)]
    scores = [replace(s, place=place, verdict="nothing_missing") for s, place in zip(singles, places, strict=True)]
    other = [s for s in read(RESULTS / "held.json") if s.group != "single"][:2]
    text = json.dumps({"scores": [asdict(s) for s in (*scores, *other)]})
    (folder / "held.json").write_text(text, encoding="utf-8")
    seen = {
        s.name: asdict(Seen(distance=low + 0.5, low=low, high=low + 1.0, most=most))
        for s, (low, most) in zip(singles, bounds, strict=False)
    }
    store_of(folder, "held").write_text(json.dumps(seen), encoding="utf-8")
    return [s.name for s in singles]


def test_what_was_not_named_is_listed_with_what_could_be_told_of_it(tmp_path: Path) -> None:
    bounds = [(9.0, 20.0), (0.1, HALF - 0.1), (HALF, 9.0), (HALF - 0.1, HALF + 0.5)]
    names = kept(tmp_path, bounds, [True, False, False, False, False])
    said = limit(tmp_path, (("held", "held"),))
    words = " ".join(said.split())
    assert "Measured on 3 single effects" in words and "(1 more of these splits are not measured yet)" in words
    assert "1 of the 3 cannot come so far, 1 surely do, of the other 1 it is open:" in words
    rows = [line for line in said.splitlines() if line.startswith("| h")]
    assert [row.split(" | ")[0][2:] for row in rows] == [names[1], names[3], names[2]], "the faintest first"
    assert "| nothing missing | 0.6 (0.1 to 1.1) | 2.2 |" in rows[0]
    assert limit(tmp_path, (("wide", "wide"),)) == ""


def test_every_stored_bound_is_of_a_single_effect_at_the_target_condition_and_above_the_other() -> None:
    for split in ("held", "wide"):
        cases = {c.name: c for c in cases_of(split)}
        for name, one in stored(store_of(RESULTS, split)).items():
            assert cases[name].group == "single" and len(cases[name].speeds_hz) == 3
            assert one.low <= one.distance <= one.high and one.low <= one.most
