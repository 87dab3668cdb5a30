"""Which fault of a tooth it is: the nearest other one, its size free, over the noise of the mean turn."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from proof import apart as aparts
from proof.apart import FAR, Apart, apart, mean_turn, of_a_tooth, rivals, store_of, stored
from proof.limit import told_apart
from proof.others import cases_of
from proof.plan import Hiding
from proof.score.rates import at_target
from proof.whole import read

RESULTS = Path(__file__).parents[2] / "proof" / "results"
CASES = {c.name: c for c in cases_of("wide")}
CRACK = CASES["w023"]


class Ear:
    """Hears a fault as its direction times its size."""

    def __init__(self, directions: dict[tuple[str, int], np.ndarray]) -> None:
        self.directions, self.asked = directions, []

    def of(self, _case: object) -> Ear:
        return self

    def heard(self, fault: Hiding) -> np.ndarray:
        self.asked.append(fault)
        return fault.value * self.directions[fault.law, fault.variant]


def test_another_fault_is_taken_at_the_size_that_comes_nearest(monkeypatch: pytest.MonkeyPatch) -> None:
    ear = Ear(
        {
            ("root_crack", 1): np.array([3.0, 4.0j, 0.0]),
            ("broken_tooth", 0): np.array([2.0, 0.0, 0.0]),
            ("flank_pit", 0): np.array([0.0, 0.4j, 0.3]),
        }
    )
    monkeypatch.setattr(aparts, "_Ear", ear)
    found = apart(replace(CRACK, effects=(replace(CRACK.effects[0], value=0.1),)))
    assert found.seen == pytest.approx(0.5)
    assert found.rivals["broken_tooth 0"] == pytest.approx(0.4), "what is left is across it"
    assert found.rivals["flank_pit 0"] == pytest.approx(np.sqrt(0.25 - 0.32**2))
    assert (found.least, found.nearest) == (found.rivals["flank_pit 0"], "flank_pit")
    assert [f.value for f in ear.asked if f.law == "flank_pit"] == [0.6], "near enough to be scaled"
    assert [f.value for f in ear.asked if f.law == "broken_tooth"] == pytest.approx([0.1, 0.15]), "simulated again"


def test_a_fault_that_pushes_the_other_way_is_no_nearer_than_a_sound_tooth(monkeypatch: pytest.MonkeyPatch) -> None:
    here = np.array([1.0 + 1.0j, 2.0])
    ear = Ear({("root_crack", 1): here, ("broken_tooth", 0): -here, ("flank_pit", 0): -0.1 * here})
    monkeypatch.setattr(aparts, "_Ear", ear)
    found = apart(CRACK)
    assert found.rivals["broken_tooth 0"] == pytest.approx(found.seen) == found.least


def test_rivals_are_all_other_faults_of_that_tooth_in_all_their_variants() -> None:
    of_a_crack = list(rivals(CRACK.effects[0]))
    assert [(r.law, r.variant) for r in of_a_crack] == [("broken_tooth", 0), ("flank_pit", 0)]
    assert of_a_crack[0].value == CRACK.effects[0].value and of_a_crack[0].site == "pinion"
    broken = CASES["w063"].effects[0]
    assert [(r.law, r.variant) for r in rivals(broken)] == [("root_crack", 0), ("root_crack", 1), ("flank_pit", 0)]
    assert of_a_tooth(CRACK) and not of_a_tooth(CASES["w003"]) and not of_a_tooth(CASES["w025"])


@pytest.mark.parametrize("ratio", [1.0, 27 / 53])
def test_the_mean_turn_keeps_what_comes_back_and_the_more_turns_the_less_of_the_rest(ratio: float) -> None:
    angle = 2.0 * np.pi * 31.3 * np.arange(24000) / 20000.0
    rng = np.random.default_rng(4)
    noise = rng.normal(size=angle.size)
    turn = angle * ratio
    heard = np.array([angle, 2.0 * np.cos(7.0 * turn + 0.5), np.sin(7.5 * turn), noise])
    found = np.abs(mean_turn(heard, ratio))
    turns = int(turn[-1] / (2.0 * np.pi))
    assert found[0, 7] == pytest.approx(1.0, rel=1e-3) and np.delete(found[0], 7).max() < 1e-3
    assert found[1].max() < 1.5 / turns, "half orders are gone but for an odd turn"
    assert np.mean(found[2, 1:] ** 2) * found.shape[1] * turns * 2 == pytest.approx(1.0, rel=0.3)


@pytest.mark.slow
def test_a_broken_piece_is_told_from_a_crack_less_well_than_from_a_sound_tooth() -> None:
    case = replace(CASES["w063"], speeds_hz=(30.0,))
    found = apart(case)
    assert set(found.rivals) == {"root_crack 0", "root_crack 1", "flank_pit 0"}
    assert found.seen > 5.0 and all(0.5 < distance < found.seen for distance in found.rivals.values())


def test_every_stored_distance_is_of_one_fault_of_a_tooth_and_below_that_from_a_sound_one() -> None:
    count = 0
    for split in ("wide", "held", "teeth", "entire", "next"):
        cases = {c.name: c for c in cases_of(split)}
        for name, one in stored(store_of(RESULTS, split)).items():
            assert of_a_tooth(cases[name])
            assert all(0.0 < distance <= one.seen * 1.0001 for distance in one.rivals.values())
            count += 1
    assert count >= 10


def test_the_page_lists_them_the_nearest_first(tmp_path: Path) -> None:
    scores = [s for s in read(RESULTS / "wide.json") if s.name in {"w023", "w063"}]
    assert all(at_target(s) for s in scores)
    (tmp_path / "wide.json").write_text(json.dumps({"scores": [asdict(s) for s in scores]}), encoding="utf-8")
    kept = {
        "w023": asdict(Apart(seen=10.0, rivals={"broken_tooth 0": FAR + 1.0, "flank_pit 0": 7.0})),
        "w063": asdict(Apart(seen=8.0, rivals={"root_crack 0": 5.0, "flank_pit 0": 2.0})),
    }
    store_of(tmp_path, "wide").write_text(json.dumps(kept), encoding="utf-8")
    said = told_apart(tmp_path, (("wide", "wide"),))
    assert "1 of 2 stay below it" in " ".join(said.split())
    rows = [line for line in said.splitlines() if line.startswith("| w")]
    assert rows[0].startswith("| w063 |") and rows[0].endswith("| 8.0 | pit of a tooth's flank | 2.0 | 25 % |")
    assert rows[1].endswith("| 10.0 | broken tooth | 4.3 | 43 % |")
    assert told_apart(tmp_path, (("held", "held"),)) == ""
