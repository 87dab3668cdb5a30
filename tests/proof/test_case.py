"""Cases on disk: the same bytes every time, readable by the product, sealed, and with the truth kept apart."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.cli.parameters import read_parameters
from app.cli.recordings import Given, read_recording
from proof import case as made
from proof import seal
from proof.chain import random_noise, random_path, sampled, through
from proof.plan import plan
from proof.run_up import wandering
from proof.sensor_faults import FAULTS, Place, spoil
from sim.terms import REGISTRY


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(made, "DURATION_S", 0.1)


def of_group(group, split="dev"):
    return next(c for c in plan(split) if c.group == group and len(c.speeds_hz) == 1)


def files(folder):
    return {p.relative_to(folder): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.mark.slow
def test_the_same_case_has_the_same_bytes(short, tmp_path):
    case = of_group("single")
    for name in ("one", "two"):
        made.make(case, tmp_path / name / "cases", tmp_path / name / "truth")
    assert files(tmp_path / "one") == files(tmp_path / "two")
    assert len(files(tmp_path / "one")) == 6


@pytest.mark.slow
def test_what_is_there_is_left_alone(short, tmp_path):
    case = of_group("open")
    made.make(case, tmp_path / "cases", tmp_path / "truth")
    (tmp_path / "cases" / case.name / "test_1.npz").write_bytes(b"kept")
    made.make(case, tmp_path / "cases", tmp_path / "truth")
    assert (tmp_path / "cases" / case.name / "test_1.npz").read_bytes() == b"kept"


@pytest.mark.slow
def test_the_product_reads_machine_and_recordings(short, tmp_path):
    case = of_group("sensor")
    made.make(case, tmp_path / "cases", tmp_path / "truth")
    folder = tmp_path / "cases" / case.name
    machine = read_parameters(folder / "machine.json").machine
    assert {b.name for b in machine.bearings} == {f"bearing{i}" for i in range(1, 5)}
    recording = read_recording(folder / "test_1.npz", Given())
    assert recording.sampling_rate_hz == 20_000
    assert recording.samples.shape == (len(case.sensors), 2_000)
    assert recording.operating.speed_hz == case.speeds_hz[0]
    assert [f"{c.location}.{c.axis}" for c in recording.channels] == list(case.sensors)


@pytest.mark.slow
def test_no_file_for_the_engine_tells_what_is_hidden(short, tmp_path):
    case = of_group("single")
    made.make(case, tmp_path / "cases", tmp_path / "truth")
    words = {case.group, case.effects[0].law, *case.effects[0].about().terms}
    for path in (tmp_path / "cases").rglob("*.json"):
        assert not [w for w in words if w in path.read_text()]
    truth = json.loads((tmp_path / "truth" / f"{case.name}.json").read_text())
    assert truth["effects"][0]["law"] == case.effects[0].law


def test_the_registry_knows_every_term_of_a_truth():
    known = set(REGISTRY.keys())
    for case in (*plan("dev"), *plan("sealed"), *plan("later"), *plan("third")):
        for effect in made.truth_of(case)["effects"]:
            assert set(effect["terms"]) <= known
        assert {term for term, _ in case.causes} <= known


@pytest.mark.parametrize("split", ["dev", "sealed", "later", "third"])
def test_the_committed_seals_are_those_of_the_plan(split):
    found = seal.manifest(split, plan(split))["sha256"]
    assert found == seal.seals_of(split)


def test_a_changed_truth_breaks_its_seal(tmp_path):
    cases = plan("dev")[:3]
    for case in cases:
        (tmp_path / f"{case.name}.json").write_text(made.canonical(made.truth_of(case)))
    seals = seal.manifest("dev", cases)["sha256"]
    assert seal.broken(cases, tmp_path, seals) == []
    changed = tmp_path / f"{cases[1].name}.json"
    changed.write_text(changed.read_text().replace("20.0", "30.0"))
    assert seal.broken(cases, tmp_path, seals) == [cases[1].name]


def test_mis_set_machines_differ_in_two_parameters(short, tmp_path):
    case = next(c for c in plan("dev") if c.group == "misset")
    told, nominal = made.told(case), made.told(plan("dev")[0])
    wrong = [k for k in told if k != "fr1" and abs(told[k] / max(nominal[k], 1e-30) - 1.0) > 0.15 and nominal[k]]
    assert len(wrong) == 2


def test_the_speed_is_the_derivative_of_the_angle():
    speed = wandering(30.0, 0.004, np.random.default_rng(1))
    t = np.linspace(0.0, 2.0, 200_001)
    numeric = np.gradient(speed.angle(t), t)
    assert np.allclose(numeric[5:-5], speed.rate(t)[5:-5], rtol=1e-6)
    assert np.std(speed.rate(np.linspace(0, 200, 100_000))) / (60 * np.pi) == pytest.approx(0.004, rel=0.05)


def test_the_filter_keeps_what_is_below_and_removes_what_would_fold():
    t = np.arange(120_000) / 120_000
    inside, outside = (np.sin(2 * np.pi * f * t)[None, :] for f in (5_000.0, 13_000.0))
    assert np.std(sampled(inside, 6)[0, 100:-100]) == pytest.approx(np.sqrt(0.5), rel=0.01)
    assert np.std(sampled(outside, 6)[0, 100:-100]) < 1e-2


def test_transfer_paths_stay_within_their_gain_and_noise_has_its_level():
    rng = np.random.default_rng(5)
    impulse = np.zeros(4096)
    impulse[0] = 1.0
    for _ in range(20):
        way = random_path(rng)
        response_db = 20 * np.log10(np.abs(np.fft.rfft(through(way, impulse))) / way.gain)
        assert 3 <= len(way.sections) <= 6
        assert np.all(np.abs(response_db) < 6.0 * len(way.sections))
    noise = random_noise(2.5, rng)
    assert np.std(noise.draw(20_000, rng)) == pytest.approx(2.5)


@pytest.mark.parametrize("fault", sorted(FAULTS))
def test_a_sensor_fault_changes_its_channel_only(fault):
    rng = np.random.default_rng(3)
    before = rng.standard_normal((3, 20_000))
    phi = 2 * np.pi * 30 * np.arange(20_000) / 20_000
    after = before.copy()
    spoil(after, fault, Place(channel=1, other=2, phi=phi), rng)
    assert np.array_equal(after[0], before[0])
    assert not np.array_equal(after[1], before[1])
    assert np.array_equal(after[2], before[1] if fault == "swapped" else before[2])
    assert np.all(np.isfinite(after))


def test_an_alias_falls_as_the_speed_rises():
    images = []
    for hz in (25.0, 30.0):
        samples = 0.1 * np.random.default_rng(3).standard_normal((1, 20_000))
        phi = 2 * np.pi * hz * np.arange(20_000) / 20_000
        spoil(samples, "aliasing", Place(channel=0, other=0, phi=phi), np.random.default_rng(1))
        images.append(int(np.argmax(np.abs(np.fft.rfft(samples[0])))))
    assert images == [20_000 - 560 * 25, 20_000 - 560 * 30]
