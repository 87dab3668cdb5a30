"""Labels of simulated machines: every strong line has its reason, and one wording a family."""

from __future__ import annotations

from collections import defaultdict
from functools import cache

import pytest

from jobs.labelling import Predicted, label_sets
from signals.labels.types import LabelSet
from signals.recording import from_response
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings


@cache
def labels(name: str, steps: int | None = None) -> LabelSet:
    """Amplitude spectrum of the first sensor, 2 s at 20 kHz."""
    settings = Settings(estimate_error=False, steps_per_output=steps)
    run = simulate(preset(name), duration_s=2.3, output_rate_hz=20_000.0, settings=settings)
    series = from_response(run).select(start_s=0.3).series(run.channels[0].name)
    known = Predicted(machine=run.machine, seed=0, bases_hz=run.bases_hz, step_s=run.quality.step_s)
    found = label_sets(series, known)
    assert found is not None
    return found.amplitude


@pytest.mark.slow
def test_a_rotors_high_multiples_are_its_balls_and_the_rest_the_steps() -> None:
    found = labels("rotor")
    balls = [p for p in found.peaks if p.family == "outer" and p.amplitude]
    assert {p.label for p in balls} == {f"{k}*f_o1" for k in range(1, len(balls) + 1)} and len(balls) > 85
    assert {(p.status, p.mechanisms) for p in balls} == {("present", ("ball_contact",))}
    images = [p for p in found.peaks if p.family == "numerical"]
    assert len(images) > 100 and found.unexplained <= 2
    # 80 dB below the largest, and gone with half the step
    assert max(p.amplitude or 0.0 for p in images) < 1e-4 * max(p.amplitude or 0.0 for p in balls)
    finer = labels("rotor", steps=6)
    assert len([p for p in finer.peaks if p.family == "numerical"]) < 0.1 * len(images)
    assert len([p for p in finer.peaks if p.family == "outer" and p.amplitude]) == len(balls)


@pytest.mark.slow
def test_lines_of_the_steps_are_not_taken_for_run_out() -> None:
    """60000 steps a second against 690 Hz fold to multiples of 30 Hz, the shaft's; 80000 to multiples of 10 Hz."""
    for steps in (3, 4):
        found = labels("gear-pair", steps=steps)
        assert found.frequencies_hz["f_s"] == pytest.approx(steps * 20_000.0)
        assert not [p for p in found.with_status("present") if p.family not in ("mesh", "numerical")]
        assert not [p for p in found.with_status("present") if p.family == "mesh" and "f_r" in p.label]
        assert {f"{k}*f_m" for k in range(1, 14)} <= {p.label for p in found.with_status("present")}
        assert found.unexplained <= 0.05 * found.found


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper-demo", "paper-lightly-damped", "two-stage"])
def test_a_family_has_one_wording(name: str) -> None:
    told = defaultdict(set)
    for peak in labels(name).peaks:
        bases = frozenset(term.split("*")[1] for term in peak.label.replace("-", "+").split("+") if term)
        # a line of two families is told of both
        if peak.label and not peak.aliases:
            told[bases, peak.family == "combination"].add((peak.family, peak.mechanisms))
    assert told
    for (bases, _), wordings in told.items():
        rest = {w for w in wordings if w[1] != ("intermodulation",)}
        assert len(rest) <= 1, (sorted(bases), wordings)


@pytest.mark.slow
def test_families_that_nothing_excites_are_not_present_in_the_demo() -> None:
    """No term of the demo speaks of a ball's or the cage's own rotation."""
    found = labels("paper-demo")
    assert not [p for p in found.with_status("present") if p.family in ("ball", "cage")]
    assert {f"{k}*f_o1" for k in range(1, 9)} <= {p.label for p in found.with_status("present")}
    assert {"1*f_m-1*f_r1", "1*f_m+1*f_r1"} <= {p.label for p in found.with_status("present")}
    assert found.false_match.families < 0.02 and found.false_match.combinations < 0.03


@pytest.mark.slow
def test_an_inner_spall_is_named_where_it_is_strongest_and_demodulated_there() -> None:
    machine = preset("rotor")
    spall = TermSpec(term="inner_spall", site="bearing1", parameters={"width": 1e-3})
    machine = machine.model_copy(update={"terms": [*machine.terms, spall]})
    settings = Settings(estimate_error=False)
    run = simulate(machine, duration_s=1.0, output_rate_hz=30_000.0, settings=settings)
    series = from_response(run).select(start_s=2 / 30).series(run.channels[0].name)
    found = label_sets(series, Predicted(machine=machine, seed=0, bases_hz=run.bases_hz, step_s=run.quality.step_s))
    assert found is not None
    ranked = sorted((p for p in found.amplitude.peaks if p.amplitude), key=lambda p: -(p.amplitude or 0.0))
    assert {p.label for p in ranked[:3]} == {"30*f_i1+2*f_r1", "29*f_i1+2*f_r1", "30*f_i1-2*f_r1"}
    assert {(p.status, p.mechanism, p.component) for p in ranked[:200]} == {("present", "inner_spall", "bearing1")}
    assert found.amplitude.unexplained < 0.4 * found.amplitude.found
    assert len(found.amplitude.with_status("ambiguous")) < 0.02 * found.amplitude.found
    assert found.amplitude.false_match.combinations + found.amplitude.false_match.families <= 0.05
    band = found.envelope.band
    assert band is not None and band.impulsive and band.high_hz > 5000.0
    strongest = max(found.envelope.peaks, key=lambda p: p.amplitude or 0.0)
    assert (strongest.label, strongest.mechanism) == ("1*f_i1", "inner_spall")
