"""The page says what an oracle tells of the single effects that the engine did not name."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

from proof.limit import HALF, limit
from proof.oracle import Seen, store_of, stored
from proof.others import cases_of
from proof.score.rates import at_target
from proof.whole import read

RESULTS = Path(__file__).parents[2] / "proof" / "results"


def kept(folder: Path, powers: list[float], places: list[bool]) -> list[str]:
    """So many single effects of `held` at the target condition with these answers and oracles; their names."""
    singles = [s for s in read(RESULTS / "held.json") if s.group == "single" and at_target(s)][: len(places)]
    scores = [replace(s, place=place, verdict="nothing_missing") for s, place in zip(singles, places, strict=True)]
    other = [s for s in read(RESULTS / "held.json") if s.group != "single"][:2]
    text = json.dumps({"scores": [asdict(s) for s in (*scores, *other)]})
    (folder / "held.json").write_text(text, encoding="utf-8")
    seen = {s.name: asdict(Seen(distance=10.0 * p, power=p)) for s, p in zip(singles, powers, strict=False)}
    store_of(folder, "held").write_text(json.dumps(seen), encoding="utf-8")
    return [s.name for s in singles]


def test_what_was_not_named_is_listed_with_what_the_oracle_tells(tmp_path: Path) -> None:
    names = kept(tmp_path, [0.9, 0.02, HALF, 0.3], [True, False, False, False, False])
    said = limit(tmp_path, (("held", "held"),))
    assert "Measured on 4 single effects at the target condition, 1 of them named" in said
    assert "the oracle tells 2 in half of its tests" in " ".join(said.split())
    assert "Of the 3 that were not named it does not tell 2:" in " ".join(said.split())
    rows = [line for line in said.splitlines() if line.startswith("| h")]
    assert [row.split(" | ")[0][2:] for row in rows] == [names[1], names[3], names[2]], "the faintest first"
    assert "| nothing missing | 0.2 | 2 % |" in rows[0]
    assert limit(tmp_path, (("wide", "wide"),)) == ""


def test_every_stored_oracle_is_of_a_single_effect_at_the_target_condition() -> None:
    found = stored(store_of(RESULTS, "held"))
    cases = {c.name: c for c in cases_of("held")}
    assert found and all(cases[name].group == "single" and len(cases[name].speeds_hz) == 3 for name in found)
    assert all(0.0 <= one.power <= 1.0 and one.distance >= 0.0 for one in found.values())
