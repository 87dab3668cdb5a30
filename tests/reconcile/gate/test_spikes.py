"""Single samples far out are told and filled; blows of a machine, which ring, are left as they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.gate.spikes import spike_findings, spikes, without_spikes
from reconcile.gate.spoiled import doubts
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from signals.recording import Recording
from tests.strategies.impulses import N, recorded, sound, train

PLACES = (20_000, 50_000, 77_000)


def spiked(x, places: tuple[int, ...] = PLACES, height: float = 200.0) -> Recording:  # type: ignore[no-untyped-def]
    row = np.array(x)
    for k, place in enumerate(places):
        row[place] += (-1) ** k * height * float(np.std(x))
    return recorded(row)


def blows(seed: int, height: float = 8.0):  # type: ignore[no-untyped-def]
    return sound(seed) + train(np.random.default_rng(seed), 3.5561, height)


@pytest.mark.parametrize("seed", [1, 2])
def test_three_single_samples_are_found_and_filled(seed: int) -> None:
    for x in (sound(seed), blows(seed)):
        one = spiked(x)
        assert tuple(spikes(one.samples[0])) == PLACES
        (found,) = spike_findings(one, "test 1")
        assert (found.kind, found.channel, found.fault) == ("spikes", "a0", False)
        assert found.detail.startswith("3 single samples stand far out of the signal, at 1, 2.5, 3.85 s")
        filled = without_spikes(one).samples[0]
        assert np.max(np.abs(filled - x)[list(PLACES)]) < 5 * np.std(x)
        assert np.array_equal(np.delete(filled, PLACES), np.delete(one.samples[0], PLACES))


@pytest.mark.parametrize("height", [1.0, 10.0, 100.0])
def test_blows_and_noise_are_none(height: float) -> None:
    assert not spikes(blows(3, height)).size and not spikes(sound(3)).size
    assert not spike_findings(recorded(sound(3)), "test 1")


def test_one_is_told_as_one_and_many_are_how_the_signal_is() -> None:
    assert spike_findings(spiked(sound(1), (5000,)), "test 1")[0].detail.startswith("1 single sample stands far out")
    for apart in (40, 16):  # more than may be single ones, and more than are looked at
        assert not spikes(spiked(sound(1), tuple(range(100, N - 100, apart))).samples[0]).size
    x = sound(1)
    x[100] = np.nan
    assert not spikes(x).size and not spikes(np.zeros(N)).size and not spikes(x[:20]).size


def test_the_gate_says_so_and_finds_no_fault_in_it() -> None:
    gate = inspect_measurement([], [spiked(sound(2))], orders=(3.58,))
    assert gate.fault is None and [f.kind for f in gate.findings] == ["spikes"]
    assert doubts(gate)[0].startswith("a0 of test 1: spikes, 3 single samples")
    assert float(np.max(np.abs(gate.tests[0].samples))) < 10.0


def test_many_that_the_baseline_has_not_are_a_fault_and_filled_too() -> None:
    """Sixty a second at moments that nothing tells, some of them within a millisecond of the next."""
    rng = np.random.default_rng(10)
    places = tuple(sorted(rng.choice(np.arange(100, N - 100), 60 * N // 20_000, replace=False).tolist()))
    apart = np.diff(places).min()
    assert 2 < apart < 12
    gate = inspect_measurement([recorded(sound(5))], [spiked(sound(2), places)], orders=(3.58,))
    assert gate.fault is not None and (gate.fault.kind, gate.fault.channel) == ("spikes", "a0")
    assert gate.usable and float(np.max(np.abs(gate.tests[0].samples))) < 10.0
    both = inspect_measurement([spiked(sound(5), places)], [spiked(sound(2), places)], orders=(3.58,))
    assert [(f.recording, f.fault) for f in both.findings if f.kind == "spikes"] == [
        ("baseline 1", False),
        ("test 1", False),
    ], "as many as the baseline has explain no difference"
    assert both.fault is None


def test_two_in_a_short_record_are_not_many() -> None:
    short = replace(spiked(sound(2), (3000, 6000)), samples=spiked(sound(2), (3000, 6000)).samples[:, :8192])
    assert [(f.kind, f.fault) for f in spike_findings(short, "test 1")] == [("spikes", False)]


@pytest.mark.parametrize("missed", [0.0, 0.5])
def test_contacts_shorter_than_a_sample_that_come_evenly_are_the_machine_s(missed: float) -> None:
    """An outer race in a casing that rings on nowhere: each blow is one sample, and some fall between two."""
    rng = np.random.default_rng(4)
    moments = np.cumsum(187.0 * (1.0 + 0.005 * rng.standard_normal(N // 187 - 4)))
    places = tuple(int(p) for p in np.round(moments[rng.random(moments.size) >= missed]))
    x = spiked(sound(2), places)
    x = replace(x, samples=sound(2)[None] + (x.samples - sound(2)) * rng.uniform(0.5, 1.5, N))
    assert len(places) > 200 and not spikes(x.samples[0]).size
    gate = inspect_measurement([recorded(sound(5))], [x], orders=(3.58,))
    assert gate.fault is None and float(np.max(np.abs(gate.tests[0].samples))) > 100.0
    scattered = tuple(sorted(rng.choice(np.arange(100, N - 100), len(places), replace=False).tolist()))
    assert len(spikes(spiked(sound(2), scattered).samples[0])) > 0.9 * len(places)


@pytest.mark.slow
def test_they_change_no_answer() -> None:
    bearing = {"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    for x in (sound(2), blows(2)):
        one, bare = spiked(x), recorded(x)
        short = [replace(r, samples=r.samples[:, 10_000:60_000]) for r in (one, bare)]
        reports = [reconcile_kinematics(spec, [r], [], seed=3) for r in short]
        assert reports[0].verdict == reports[1].verdict
        assert [c.term for c in reports[0].causes] == [c.term for c in reports[1].causes]
        assert any("2 single samples" in text for text in reports[0].where.limits)


@pytest.mark.parametrize(("deviations", "told"), [(28.0, False), (32.0, True), (45.0, True)])
def test_a_sample_is_a_spike_from_thirty_deviations_of_what_its_neighbours_do_not_tell(
    deviations: float, told: bool
) -> None:
    for x in (sound(6, 0.5), 1e-3 * sound(7, 0.5), np.random.default_rng(8).standard_normal(10_000)):
        untold = x[1:-1] - (x[:-2] + x[2:]) / 2
        usual = 1.4826 * float(np.median(np.abs(untold)))
        x[5000] = (x[4999] + x[5001]) / 2 + deviations * usual
        assert spikes(x).tolist() == ([5000] if told else [])
