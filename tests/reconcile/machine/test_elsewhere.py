"""The same effect at another place that forecasts held-out data better leaves the place open."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine.decide import PLACE_OPEN, Decision
from reconcile.machine.elsewhere import better_elsewhere, placed_by_forecast
from reconcile.machine.weigh import of_the_set
from reconcile.machine.words import sentence
from reconcile.verdict import HeldOut, Placebo

NAMED = Decision(word="explained", chosen=("outer_spall@bearing1",), p=1e-9, reasons=())
HELD = HeldOut(
    metric="log_spectral_distance", unit="dB", before=7.0, after=3.8, gain=0.46, gain_low=0.38, gain_high=0.52,
    retuned=0.06, black_box=0.4, placebo=0.54, held="each operating point in turn", ceiling=0.8, numbers=4,
    placebos=(
        Placebo(term="ball_spall", site="bearing1", gain=0.7, draws=16),
        Placebo(term="outer_spall", site="bearing2", gain=0.54, draws=16),
        Placebo(term="outer_spall", site="bearing4", gain=0.0, draws=2),
    ),
    effects=("outer_spall@bearing1",),
)  # fmt: skip


def test_a_better_forecast_of_the_same_effect_elsewhere_opens_the_place() -> None:
    told = placed_by_forecast(NAMED, HELD)
    assert (told.word, told.chosen) == ("ambiguous", ("outer_spall@bearing1", "outer_spall@bearing2"))
    assert told.p == NAMED.p
    (reason,) = told.reasons
    assert reason == (
        f"{PLACE_OPEN}: on data it was not fitted to bearing2 does better (54 %) than bearing1 (46 %), "
        "which fits better"
    )
    assert "outer-race spall at bearing1, or outer-race spall at bearing2" in sentence(told, None, HELD)
    shown = of_the_set({"outer_spall@bearing1": 0.99, "outer_spall@bearing2": 0.01}, told.chosen)
    assert shown == {"outer_spall@bearing1": 0.5, "outer_spall@bearing2": 0.5}


@pytest.mark.parametrize(
    "held",
    [
        None,
        replace(HELD, gain_high=0.55),
        replace(HELD, placebos=HELD.placebos[:1]),
        replace(HELD, effects=("outer_spall@bearing1", "unbalance@gear")),
    ],
    ids=["no forecast", "within its interval", "another effect at the place", "two effects"],
)
def test_else_the_name_stands(held: HeldOut | None) -> None:
    assert placed_by_forecast(NAMED, held) is NAMED


@pytest.mark.parametrize("word", ["nothing_missing", "ambiguous", "not_decidable", "unknown_physics"])
def test_only_a_name_has_a_place_to_lose(word: str) -> None:
    assert better_elsewhere(replace(NAMED, word=word), HELD) is None  # type: ignore[arg-type]
