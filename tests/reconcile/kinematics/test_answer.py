"""What the sentence of a bearing defect says of the data that it was not fitted to."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import answer, read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.answer import gained
from reconcile.verdict import NO_GAIN, HeldOut
from tests.strategies.brief import recorded, sound, train


def held(gain: float) -> HeldOut:
    return HeldOut(
        metric="m", unit="dB", before=2.0, after=2.0 * (1 - gain), gain=gain, gain_low=gain - 0.3, gain_high=gain + 0.3,
        retuned=None, black_box=0.1, placebo=None,
    )  # fmt: skip


def test_a_loss_is_said() -> None:
    assert gained(held(-0.13)) == gained(held(0.0)) == NO_GAIN
    assert gained(held(0.2)) == gained(None) == ""


@pytest.mark.slow
@pytest.mark.parametrize("gain", [-0.13, 0.4])
def test_the_verdict_stands_and_its_sentence_says_the_loss(gain: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answer, "held_out", lambda *_: held(gain))
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    test = sound(2) + train(np.random.default_rng(2), 3.5848 * 0.992, 1.0)
    report = reconcile_kinematics(spec, [recorded(test)], [recorded(sound(1))], seed=0)
    assert report.verdict == "explained" and report.causes[0].named
    assert (NO_GAIN in report.sentence) == (gain <= 0.0)
