"""All stages on a small atlas: a spall hidden in the paper's gearbox is found, and a sound machine is left alone."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from scipy.signal import welch

from reconcile.atlas.candidates import Candidate
from reconcile.calibrate.uncertain import DRIFT, draw_offsets, moved, uncertain_numbers
from reconcile.entry import reconcile_recordings
from reconcile.machine import engine
from reconcile.observe.statistics import third_octaves
from reconcile.report.pictures import numbers, several
from reconcile.verdict import Report
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.reconcile import prebuilt
from tests.reconcile.few import BUDGET
from tests.reconcile.remembered import Simulated

RATE_HZ = 20480.0
SETTLE_S = 0.3
SPEED_HZ = 30.0
PLACES = ("bearing1", "bearing3")
SPALL = TermSpec(term="outer_spall", site="bearing1", parameters={"width": 2.0e-3, "angle": 1.4})
"""In the load zone: elsewhere on the fixed ring no ball is pressed into it. So large that its pattern shows on these
few machines too (evidence 3.5; one of 1.5 mm comes to 2.9, where 3 is asked)."""
NOMINATED = tuple(
    Candidate(term=term, site=site)
    for term, site in (
        ("outer_spall", "bearing1"),
        ("outer_spall", "bearing3"),
        ("inner_spall", "bearing1"),
        ("tooth_crack", "pinion"),
        ("unbalance", "pinion"),
    )
)


def wanted() -> prebuilt.Wanted:
    """The atlas, which stands beside this test."""
    sensors = tuple(f"{place}.y" for place in PLACES)
    bank = Path(__file__).parent / "atlas" / f"spall-{SPEED_HZ:g}hz.npz"
    return prebuilt.wanted(preset("paper-lightly-damped"), NOMINATED, sensors, SPEED_HZ, bank)


def measured(machine: MachineSpec, seed: int, duration_s: float = 3.0) -> Recording:
    """Accelerations on two bearings with white noise of a tenth of each signal's deviation."""
    response = simulate(
        machine,
        duration_s=SETTLE_S + duration_s,
        output_rate_hz=RATE_HZ,
        channels=["resonator1.y.acceleration", "resonator3.y.acceleration"],
        seed=seed,
        settings=Settings(rtol=1e-3, estimate_error=False),
    )
    rows = np.asarray(response.signals)[:, round(SETTLE_S * RATE_HZ) :]
    noise = np.random.default_rng(seed).normal(size=rows.shape) * 0.1 * rows.std(axis=1, keepdims=True)
    channels = tuple(Channel(name=p, quantity="acceleration", unit="m/s^2", location=p, axis="y") for p in PLACES)
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=channels,
        samples=rows + noise,
        operating=Operating(shaft="input", speed_hz=SPEED_HZ, torque_nm=25.0),
    )


@pytest.fixture(scope="module")
def atlas(tmp_path_factory: pytest.TempPathFactory) -> prebuilt.Kept:
    return prebuilt.kept([wanted()], tmp_path_factory.mktemp("atlas"))


@pytest.fixture(scope="module")
def real() -> MachineSpec:
    """Not the nominal machine: every number is off as numbers of drawings are."""
    nominal = preset("paper-lightly-damped")
    known = uncertain_numbers(nominal)
    return moved(nominal, known, draw_offsets(known, np.random.default_rng(77)))


@pytest.fixture(scope="module")
def baseline(real: MachineSpec) -> Recording:
    return measured(real, 501)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.xdist_group("reconcile-machine")
def test_a_hidden_spall_is_found(
    real: MachineSpec,
    baseline: Recording,
    atlas: prebuilt.Kept,
    simulated: Simulated,
    few_machines: None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    placed: list[tuple[Report, tuple[object, ...]]] = []

    def taken_back(report: Report, *more: object) -> Report:
        placed.append((report, more))
        return replace(report, causes=tuple(replace(c, named=False) for c in report.causes))

    monkeypatch.setattr(engine, "with_place", taken_back)
    known = uncertain_numbers(real)
    later = draw_offsets(known, np.random.default_rng(78))
    drifted = moved(real, known, type(later)(values=DRIFT * later.values))
    test = measured(drifted.model_copy(update={"terms": [*drifted.terms, SPALL]}), 502)
    nominal = preset("paper-lightly-damped")
    heard: list[float] = []
    report = reconcile_recordings(
        nominal,
        [test],
        [baseline],
        budget=BUDGET,
        keeper=atlas,
        mapper=simulated,
        nominated=NOMINATED,
        progress=lambda share, _stage: heard.append(share),
    )
    assert report.level == "machine"
    assert report.verdict in ("explained", "ambiguous"), report.sentence
    best = report.causes[0]
    assert ("outer_spall", "bearing1") in [(c.term, c.site) for c in report.causes if c.score > best.score - 3.0]
    assert report.where.sites[0].site == "bearing1"
    cause = next(c for c in report.causes if (c.term, c.site) == ("outer_spall", "bearing1"))
    assert cause.severity is not None and cause.severity.low < 2.0e-3 < cause.severity.high
    assert report.held_out is not None and report.held_out.gain > 0.2
    assert report.machine is not None
    again = MachineSpec.model_validate(report.machine)
    assert again.terms[-1].term == best.term
    assert heard == sorted(heard) and heard[-1] == 1.0
    ((before, (impacts, points, sensors)),) = placed
    assert not any(row["named"] for row in cast(list[dict[str, object]], report.pictures["ranking"]))
    assert before.held_out is not None and (points, sensors) == (1, PLACES)
    assert cast(Mapping[str, float], impacts)["outer_spall@bearing1"] > 0.0
    json.dumps(report.document())
    simulated_as_drawn(again, report)


def third_octave_db(machine: MachineSpec) -> np.ndarray:
    """Power of both channels in the third octaves of the report, dB, of a run of its own: (2, bands)."""
    response = simulate(
        machine,
        duration_s=SETTLE_S + 2.0,
        output_rate_hz=RATE_HZ,
        channels=["resonator1.y.acceleration", "resonator3.y.acceleration"],
        seed=7,
        settings=Settings(rtol=1e-3, estimate_error=False),
    )
    rows = np.asarray(response.signals)[:, round(SETTLE_S * RATE_HZ) :]
    frequency, density = welch(rows, RATE_HZ, nperseg=8192)
    edges = third_octaves()
    inside = [(frequency >= low) & (frequency < high) for low, high in pairwise(edges)]
    return 10 * np.log10(np.stack([density[:, band].sum(axis=1) * frequency[1] + 1e-30 for band in inside], axis=1))


def simulated_as_drawn(machine: MachineSpec, report: Report) -> None:
    """A user's run of the revised machine, and of it without the effect, shows the change that the report draws; and
    with the gain of the sensors' paths the recorded level."""
    bare = machine.model_copy(update={"terms": machine.terms[:-1]})
    now, before = third_octave_db(machine), third_octave_db(bare)
    drawn, paths = several(report.pictures, "spectra"), several(report.pictures, "paths")
    for c in range(2):
        after, rest = (np.array(numbers(drawn[c][key])) for key in ("after_db", "before_db"))
        gain, noise = (np.array(numbers(paths[c][key])) for key in ("gain_db", "noise_db"))
        seen, sound = (10 * np.log10(10 ** ((x[c] + gain) / 10) + 10 ** (noise / 10)) for x in (now, before))
        loud = rest > rest.max() - 40.0
        assert np.median(np.abs(seen - sound - (after - rest))[loud]) < 1.0
        assert np.median(np.abs(seen - after)[loud]) < 3.0
    stage = next(s for s in report.stages if s["name"] == "revised machine")
    assert float(str(stage["left_of_it_db"])) < 0.8 * float(str(stage["level_change_db"]))


@pytest.mark.slow
@pytest.mark.xdist_group("reconcile-machine")
def test_the_same_machine_again_misses_nothing(
    baseline: Recording, atlas: prebuilt.Kept, simulated: Simulated, few_machines: None
) -> None:
    nominal = preset("paper-lightly-damped")
    hiss = np.random.default_rng(3).normal(size=baseline.samples.shape) * 1e-3 * baseline.samples.std()
    again = replace(baseline, samples=baseline.samples + hiss)
    report = reconcile_recordings(nominal, [again], [baseline], keeper=atlas, mapper=simulated, nominated=NOMINATED)
    assert report.verdict == "nothing_missing", report.sentence
    told = {(f.term, f.site): f for f in report.faintest}
    assert set(told) == {(c.term, c.site) for c in NOMINATED}
    assert all(0 <= f.seen <= f.simulated <= 8 for f in told.values())
    assert told["inner_spall", "bearing1"].seen >= 3  # every ball meets it in the load zone once a turn
    assert told["inner_spall", "bearing1"].strikes and not told["unbalance", "pinion"].strikes
    assert told["outer_spall", "bearing1"].seen < 8  # out of the load zone there is nothing to see
    assert report.causes == () and report.machine is None
    json.dumps(report.document())
