"""What there is to see of a hidden effect, with everything known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from proof import case as making
from proof import visible
from proof.plan import Case, Hiding, plan
from proof.visible import Visible, measure, stored, told, visibility
from tests.proof.remembered import Moved


def case(value: float) -> Case:
    """A loose seat at one operating point."""
    found = next(c for c in plan("dev") if c.group == "single" and len(c.sensors) == 3)
    effect = Hiding(law="loose_seat", site="bearing1", value=value, variant=0)
    return replace(found, effects=(effect,), speeds_hz=(30.0,), snr_db=20.0)


@pytest.fixture(scope="module", autouse=True)
def moved() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(making, "accelerations", Moved())
        yield


@pytest.mark.slow
def test_more_of_an_effect_shows_more_and_none_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(making, "DURATION_S", 0.4)
    faint, strong = visibility(case(0.1)), visibility(case(0.7))
    nothing = visibility(replace(case(0.1), effects=()))
    assert nothing.effect_db == 0.0 and nothing.new_share == 0.0
    assert 0.0 < faint.effect_db < 0.5 * strong.effect_db
    assert nothing.drift_db == pytest.approx(faint.drift_db) == pytest.approx(strong.drift_db), (
        "drift is without effects"
    )
    assert strong.drift_db == pytest.approx(faint.drift_db) and strong.drift_db > 0.2


@pytest.mark.slow
def test_of_two_effects_each_is_measured_beside_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(making, "DURATION_S", 0.4)
    first = case(0.5)
    second = Hiding(law="run_out", site="gear", value=1e-7, variant=0)
    one, two = visibility(first), visibility(replace(first, effects=(*first.effects, second)))
    assert one.parts_db == ()
    assert two.parts_db[0] == pytest.approx(one.effect_db, rel=0.1), "next to nothing stands beside it"
    assert two.parts_db[1] < 0.1 * one.effect_db


def test_bins_that_rise_out_of_the_noise_are_new(monkeypatch: pytest.MonkeyPatch) -> None:
    t = np.arange(4000) / 4000.0
    line, other = np.sin(2 * np.pi * 500.0 * t), 0.1 * np.sin(2 * np.pi * 900.0 * t)
    rows = (np.array([line + other]), np.array([line]), np.array([2.0 * line]), np.array([1e-3]))
    monkeypatch.setattr(visible, "quiet_tests", lambda _case: iter([rows]))
    found = visibility(case(0.1))
    assert 1 <= round(found.new_share * 2001) <= 5, "the second line's lobe"
    assert found.drift_db == pytest.approx(20 * np.log10(2.0), abs=0.4)


def test_measured_cases_are_kept_and_told(tmp_path: Path) -> None:
    store = tmp_path / "visible.json"
    assert stored(store) == {}
    store.write_text('{"s001": {"effect_db": 1.25, "drift_db": 2.0, "new_share": 0.004}}', encoding="utf-8")
    named = replace(case(0.1), name="s001")
    assert measure([named], store, 1) == {"s001": Visible(effect_db=1.25, drift_db=2.0, new_share=0.004)}
    assert told(stored(store)["s001"]) == "; spectrum moved 1.2 dB by it, 2.0 dB by drift alone, 0.4% of the bins new"
    assert told(None) == ""
    both = Visible(effect_db=3.0, drift_db=1.0, new_share=0.0, parts_db=(2.5, 0.2))
    assert told(both).startswith("; spectrum moved 3.0 dB by it (2.5, 0.2 by each beside the other), 1.0 dB")
