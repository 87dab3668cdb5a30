"""What stands beside a named effect is said, in words, as far as it is known."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine.decide import LINES_QUIET, Decision
from reconcile.machine.words import LISTED, more, next_experiment, sentence, together, with_points
from reconcile.verdict import HeldOut


def test_places_that_share_impacts_are_listed() -> None:
    said = more("impacts come from another part too", ("outer_spall@bearing4", "outer_spall@bearing3"))
    assert said == (
        " Impacts come from another part too: outer-race spall at bearing4, or outer-race spall at bearing3."
    )


def test_groups_of_features_alone_do_not_say_that_anything_is_missing() -> None:
    """A sound machine (m052 of the proof) whose drift moved the teeth's lines across the line of action by 20 dB."""
    decision = Decision(word="not_decidable", chosen=("bent_shaft@pinion",), p=4e-6, reasons=(LINES_QUIET,))
    told = sentence(decision, None, None)
    assert told.startswith("Whether anything is missing is not decided: the change is unusual (p < 0.001), but")
    assert told.endswith("; nearest is bent shaft at pinion.") and LINES_QUIET in told


def test_a_long_list_ends_with_how_many_there_are_more() -> None:
    names = [f"outer_spall@bearing{k}" for k in range(LISTED + 2)]
    assert more("impacts come from another part too", names).endswith("bearing3, or one of 2 more.")


def test_nothing_is_said_of_nothing() -> None:
    assert more("impacts come from another part too", ()) == ""


@pytest.mark.parametrize(
    ("gain", "one", "two"),
    [
        (0.42, "it takes 42 % off the distance", "Together they take 42 % off"),
        (-0.14, "it brings the spectra no nearer", "Together they bring the spectra no nearer"),
    ],
)
def test_a_loss_is_not_told_as_a_negative_gain(gain: float, one: str, two: str) -> None:
    held = HeldOut(
        metric="m", unit="dB", before=2.0, after=2.0 * (1 - gain), gain=gain, gain_low=gain, gain_high=gain,
        retuned=None, black_box=None, placebo=None,
    )  # fmt: skip
    named = Decision(word="explained", chosen=("unbalance@pinion",), p=1e-6, reasons=())
    assert one in sentence(named, None, held)
    assert two in together(held)


@pytest.mark.parametrize("sites", [("pinion", "pinion"), ("pinion", "gear")])
def test_a_bow_and_an_unbalance_are_told_apart_at_a_slow_roll(sites: tuple[str, str]) -> None:
    """Below the critical speed both load the bearings with the square of the speed."""
    chosen = (f"unbalance@{sites[0]}", f"bent_shaft@{sites[1]}")
    asked = next_experiment((*chosen, "shaft_crack@bearing1"), 0.5, 3, ["bearing1"])
    assert asked is not None and "slow roll" in asked.sentence and asked.separation_expected is None


@pytest.mark.parametrize("searched", [True, False])
def test_sizes_that_know_the_held_out_points_are_told(searched: bool) -> None:
    data = [SimpleNamespace(point=SimpleNamespace(speed_hz=hz, torque_ratio=1.0)) for hz in (22.5, 30.0)]
    plain = HeldOut(
        metric="m", unit="dB", before=2.0, after=1.0, gain=0.5, gain_low=0.4, gain_high=0.6,
        retuned=None, black_box=None, placebo=None, held="each point",
    )  # fmt: skip
    held = with_points(plain, data, searched=searched)  # type: ignore[arg-type]
    assert held.held.startswith("each point: ") and "22.5" in held.held
    assert ("searched with all points" in held.held) == searched
