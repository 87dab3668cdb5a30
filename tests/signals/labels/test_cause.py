"""Causes by counterfactual."""

from dataclasses import replace

import pytest
from gearbox import BASES, labelled

from signals.labels.cause import find_causes

WITH = {690.0: 1.0, 660.0: 0.02, 720.0: 0.03, BASES["f_o1"]: 0.01}


def test_what_goes_away_with_a_term_is_caused_by_it() -> None:
    causes = {
        c.label: c
        for c in find_causes(
            labelled(WITH), labelled({690.0: 1.0, BASES["f_o1"]: 0.005}), term="eccentricity", site="pinion"
        )
    }
    assert set(causes) == {"1*f_m", "1*f_m-1*f_r1", "1*f_m+1*f_r1", "1*f_o1"}
    assert causes["1*f_m"].share_removed == pytest.approx(0.0, abs=1e-3)
    assert causes["1*f_o1"].share_removed == pytest.approx(0.5, abs=0.02)
    assert causes["1*f_o1"].drop_db == pytest.approx(6.02, abs=0.2)
    assert not causes["1*f_o1"].at_least
    gone = causes["1*f_m+1*f_r1"]
    assert gone.at_least and gone.share_removed > 0.99


def test_label_sets_of_different_spectra_are_not_compared() -> None:
    labels = labelled(WITH)
    with pytest.raises(ValueError, match="same channel"):
        find_causes(labels, replace(labels, channel="r2"), term="eccentricity", site="pinion")
