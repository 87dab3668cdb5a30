"""When a sensor's fault is the answer, and when a revised machine is given."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine.answer import _doubtful, _machine, _told, _undecidable, _unsettled
from reconcile.machine.decide import Decision
from reconcile.machine.pairs import Pairs
from reconcile.machine.placed import with_open
from reconcile.machine.second import OF_ANOTHER, Beside
from reconcile.machine.stages import of_pairs
from reconcile.verdict import Cause, HeldOut, SensorFault, Word
from sim.presets import preset


@pytest.mark.parametrize(
    ("kind", "points", "word", "doubtful"),
    [
        ("loose_sensor", 1, "nothing_missing", True),
        ("loose_sensor", 3, "nothing_missing", False),
        ("loose_sensor", 1, "not_decidable", False),
        ("gain_change", 1, "nothing_missing", False),
    ],
)
def test_a_loose_sensor_at_one_point_is_no_answer_where_nothing_else_is_unusual(
    kind: str, points: int, word: str, doubtful: bool
) -> None:
    gate = SimpleNamespace(fault=SensorFault(kind=kind, channel="a", detail="its transfer changed"))  # type: ignore[arg-type]
    setting = SimpleNamespace(data=[None] * points)
    assert _doubtful(gate, setting, word) is doubtful  # type: ignore[arg-type]


def test_what_stands_beside_a_name_has_a_third_of_the_weight() -> None:
    """The places of m038: a loose fit, and one of three faults of a tooth of the pinion beside it."""
    teeth = ("missing_tooth@pinion", "tooth_spall@pinion", "tooth_crack@pinion")
    placed = with_open({"fit_clearance_series@bearing2": 1.0}, teeth)
    assert placed == pytest.approx({"fit_clearance_series@bearing2": 2 / 3, **dict.fromkeys(teeth, 1 / 9)})
    assert with_open({"rub@gear": 0.4, "rub@pinion": 0.6}, ()) == {"rub@gear": 0.4, "rub@pinion": 0.6}
    assert sum(with_open({teeth[0]: 0.5, "rub@gear": 0.5}, teeth).values()) == pytest.approx(1.0)


CLAIMED = (("explained", True), ("ambiguous", True), ("unknown_physics", False), ("not_decidable", False))


@pytest.mark.parametrize(("word", "given"), CLAIMED)
def test_a_machine_is_given_only_with_an_effect_that_is_claimed(word: Word, given: bool) -> None:
    revision = SimpleNamespace(machine=preset("paper-lightly-damped"))
    decision = Decision(word=word, chosen=("rub@gear",), p=1e-4, reasons=())
    assert (_machine(revision, None, decision) is not None) == given  # type: ignore[arg-type]
    assert _machine(None, None, decision) is None


HELD = HeldOut(
    metric="log_spectral_distance", unit="dB", before=4.0, after=3.0, gain=0.25, gain_low=0.2, gain_high=0.3,
    retuned=0.0, black_box=0.0, placebo=0.0,
)  # fmt: skip


@pytest.mark.parametrize("together", [True, False])
def test_the_gain_is_said_of_what_it_was_held_out_with(together: bool) -> None:
    decision = Decision(word="explained", chosen=("unbalance@pinion",), p=1e-4, reasons=())
    causes = tuple(Cause(term=t, site=s, score=9.0) for t, s in (("unbalance", "pinion"), ("rub", "gear")))
    effects = ("unbalance@pinion", "rub@gear") if together else ("unbalance@pinion",)
    held = replace(HELD, effects=effects)
    other = Beside(
        view=None, left=None, names=("rub@gear",), evidence=np.array([9.0]), p=1e-4, misfit=0.1,  # type: ignore[arg-type]
    )  # fmt: skip
    gate = SimpleNamespace(fault=None)
    _, text, _ = _told(SimpleNamespace(), decision, gate, causes, held, other, None)  # type: ignore[arg-type]
    first, second = text.split(" Beside it: ")
    assert first.startswith("Unbalance at pinion") and second.startswith("Rub at gear")
    assert ("25 %" in second) == together and ("25 %" in first) == (not together)
    assert ("Together they take" in second) == together


def test_what_was_tried_beside_the_first_is_told() -> None:
    tried = (("rub@gear", 9.0, 12.5), ("backlash@mesh1", 4.2, None))
    (stage,) = of_pairs(Pairs(first="unbalance@pinion", tried=tried))
    assert stage["adds"] == ["rub@gear: 9.0 by sums, 12.5 simulated", "backlash@mesh1: 4.2 by sums"]
    assert of_pairs(Pairs(first="unbalance@pinion", tried=())) == of_pairs(None) == ()


PLACES = ("outer_spall@bearing3", "outer_spall@bearing4")


def test_what_stands_beside_a_name_is_told_unless_it_has_a_name_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reconcile.machine.answer.struck_said", lambda *_: (OF_ANOTHER, PLACES))
    named = Decision(word="explained", chosen=("unbalance@pinion",), p=1e-6, reasons=())

    def beside(decision: Decision = named, other: str | None = None, pair: tuple[str, ...] = ()) -> tuple[str, ...]:
        second = None if other is None else SimpleNamespace(names=(other,))
        pairs = SimpleNamespace(best=SimpleNamespace(others=pair)) if pair else None
        return _unsettled(None, None, decision, second, pairs)[1]  # type: ignore[arg-type]

    assert beside() == PLACES
    assert beside(other=PLACES[1]) == ()
    assert beside(pair=("unbalance@gear", "eccentricity@gear")) == ("unbalance@gear", "eccentricity@gear")
    assert beside(replace(named, word="ambiguous")) == ()
    said = _undecidable(named, OF_ANOTHER, PLACES)
    assert said == (f"impacts come from another part too, one of these: {', '.join(PLACES)}",)
    assert _undecidable(replace(named, reasons=()), "", ()) == ()
