"""What drives a first that rattles is searched with the sizes of both."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import left_pairs

UNBALANCE, CRACK = "unbalance@pinion", "shaft_crack@bearing1"


@pytest.mark.parametrize(
    ("first", "seconds", "gains", "found", "told"),
    [
        ("pedestal_looseness@bearing1", (UNBALANCE, CRACK), (35.5, 64.5), 90.0, {UNBALANCE: 90.0}),
        ("pedestal_looseness@bearing1", (UNBALANCE, CRACK), (35.5, 64.5), 20.0, {}),
        ("pedestal_looseness@bearing1", (UNBALANCE, CRACK), (70.0, 64.5), 90.0, {}),
        ("pedestal_looseness@bearing1", (CRACK, UNBALANCE), (35.5, 64.5), 90.0, {}),
        ("pedestal_looseness@bearing1", (UNBALANCE, CRACK), (5.0, 10.0), 90.0, {}),
        ("outer_waviness@bearing1", (UNBALANCE, CRACK), (35.5, 64.5), 90.0, {}),
    ],
    ids=["drives", "no better", "best already", "not first by sums", "none adds enough", "rattles nowhere"],
)
def test_what_drives_a_first_that_rattles_is_searched_where_another_was_simulated_better(
    monkeypatch: pytest.MonkeyPatch,
    first: str,
    seconds: tuple[str, str],
    gains: tuple[float, float],
    found: float,
    told: dict[str, float],
) -> None:
    beaten: list[float] = []
    monkeypatch.setattr(left_pairs, "start_of", lambda *_: "start")
    monkeypatch.setattr(left_pairs, "searched", lambda _asked, _start, _rows, beat: beaten.append(beat) or "machines")
    monkeypatch.setattr(left_pairs, "_pair", lambda *_: SimpleNamespace(gain=found))
    monkeypatch.setattr(left_pairs, "_of_both", lambda pair: pair)
    asked = SimpleNamespace(first=first, least=30.0)
    made = {name: SimpleNamespace(gain=gain) for name, gain in zip(seconds, gains, strict=True)}
    seen_by_sums = [(name, 50.0, (0,)) for name in seconds]
    pairs = left_pairs._driven(asked, made, seen_by_sums)  # type: ignore[arg-type]
    assert {name: pair.gain for name, pair in pairs.items()} == told
    assert beaten in ([], [64.5])
