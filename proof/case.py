"""One case made: machine.json, baseline_K and test_K for the engine; the truth apart from them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from proof.chain import Noise, random_noise, random_path, sampled, through
from proof.chain import Path as Way
from proof.effects import Choice
from proof.machine import Arrays, FloatArray, Hidden, hidden_machine
from proof.model.layout import B
from proof.nominals import PAPER
from proof.plan import Case, Hiding
from proof.run_up import OVERSAMPLING, RATE_HZ, X_DOFS, Y_DOFS, Speed, accelerations, wandering
from proof.sensor_faults import Place, spoil

DURATION_S = 1.2
MISSET = ({"kp": 1.25, "mg": 0.75}, {"em": 0.72, "ks": 1.28}, {"kre": 0.7, "mr": 1.25})
"""Factors on two parameters of the machine file in the mis-set nulls."""
MACHINE, DRIFT, EFFECT, SENSORS, NOISE, SPEED, FAULT, OTHER_TEST = range(1, 9)
"""Purposes of random numbers."""


def make(case: Case, folder: Path, truth_folder: Path) -> None:
    """Write the case (folder `case.name`) and its truth; what is complete already is left alone."""
    target, truth = folder / case.name, truth_folder / f"{case.name}.json"
    if truth.exists() and (target / "machine.json").exists():
        return
    target.mkdir(parents=True, exist_ok=True)
    truth_folder.mkdir(parents=True, exist_ok=True)
    for name, (speed_hz, samples) in recordings(case).items():
        write_recording(target / name, case, speed_hz, samples)
    truth.write_text(canonical(truth_of(case)), encoding="utf-8")
    (target / "machine.json").write_text(canonical(case.nominal.document(told(case))), encoding="utf-8")


def canonical(found: Mapping[str, object]) -> str:
    """JSON whose bytes depend on the content only."""
    return json.dumps(found, sort_keys=True, indent=1) + "\n"


def truth_of(case: Case) -> dict[str, object]:
    """What is hidden in the case."""
    rows = []
    for hiding in case.effects:
        law = hiding.about()
        sites = tuple(case.nominal.named(s) for s in (hiding.site, *(law.also_at or {}).get(hiding.site, ())))
        severity = {"name": law.severity, "value": hiding.value, "unit": law.unit, "sized": law.sized}
        rows.append({**asdict(hiding), "terms": law.terms, "sites": sites, "severity": severity})
    about = asdict(case)
    if case.machine == PAPER:  # as it was sealed before there were others
        del about["machine"]
    return {**about, "effects": rows, "fault_channel": fault_place(case)[0] if case.fault else None}


def fault_place(case: Case) -> tuple[int, int]:
    """Channel of a sensor fault, and the one it is swapped with."""
    n = len(case.sensors)
    channel = int(case.rng(FAULT).integers(0, n))
    return channel, (channel + 1) % n


def told(case: Case) -> dict[str, float]:
    """Parameters as the engine is told them: nominal, and wrong where the case is about that."""
    parameters = dict(case.nominal.parameters) | {"T": case.torque_nm}
    if case.group == "misset":
        for name, factor in MISSET[case.index % len(MISSET)].items():
            parameters[name] *= factor
    return parameters


def recordings(case: Case) -> dict[str, tuple[float, FloatArray]]:
    """Stated speed and samples (channels, n) by file name."""
    base = hidden_machine(case.rng(MACHINE))
    later = base.drifted(case.rng(DRIFT))
    found: dict[str, tuple[float, FloatArray, Speed, float]] = {}
    for k, speed_hz in enumerate(case.speeds_hz, 1):
        for kind, hidden in (("baseline", base), ("test", later)):
            if kind == "baseline" and not case.baseline:
                continue
            machine = changed(_sound(hidden, case), case.effects if kind == "test" else (), case)
            speed, start = _operation(case, machine, k, kind)
            samples = _motion(case, machine, speed, start)
            found[f"{kind}_{k}"] = (speed_hz, samples, speed, start)
    reference = found[f"{'baseline' if case.baseline else 'test'}_{len(case.speeds_hz) // 2 + 1}"][1]
    ways, noises = _instruments(case, reference)
    return {
        name: (speed_hz, _plugged(case, name, samples, ways, noises, speed, start))
        for name, (speed_hz, samples, speed, start) in found.items()
    }


def instruments_of(case: Case) -> tuple[list[Way], list[Noise]]:
    """Transfer path and noise of every sensor of a case with a baseline."""
    sound, middle = _sound(hidden_machine(case.rng(MACHINE)), case), len(case.speeds_hz) // 2 + 1
    return _instruments(case, _motion(case, sound, *_operation(case, sound, middle, "baseline")))


def another_test(
    case: Case, number: int, hidden: Hidden, effects: tuple[Hiding, ...], ways: Sequence[Way]
) -> list[FloatArray]:
    """Tests of a machine of the case's, at another time, `number`, which gives speeds and slips: at every stated speed
    the samples at the plugs without noise below the angle of the drive shaft, rad, (1 + channels, n)."""
    found = []
    for k in range(1, len(case.speeds_hz) + 1):
        machine = changed(_sound(hidden, case), effects, case)
        speed, start = _turning(case, machine, k, case.rng(OTHER_TEST, number, k, 0))
        samples = _motion(case, machine, speed, start)
        rows = [through(w, row) for w, row in zip(ways, samples, strict=True)]
        found.append(np.array([speed.angle(np.arange(samples.shape[1]) / RATE_HZ), *rows]))
    return found


def with_noise(case: Case, test: Sequence[FloatArray], noises: Sequence[Noise], *purpose: int) -> list[FloatArray]:
    """The same with each sensor's noise, drawn for a purpose."""
    rng = case.rng(OTHER_TEST, *purpose)
    drawn = []
    for heard in test:
        noise = [n.draw(heard.shape[1], rng) for n in noises]
        drawn.append(heard + np.array([np.zeros(heard.shape[1]), *noise]))
    return drawn


def quiet_tests(case: Case) -> Iterator[tuple[FloatArray, FloatArray, FloatArray, FloatArray]]:
    """For every test: samples at the sensors (channels, n) with the effects, without them, without the drift too, all
    without noise, and the standard deviation of each channel's noise (channels,)."""
    every = tuple(range(len(case.effects)))
    for (first, second, third), level in _quiet(case, (every, ())):
        yield first, second, third, level


def quiet_parts(case: Case) -> Iterator[tuple[FloatArray, Sequence[FloatArray], FloatArray]]:
    """The same with all effects, with all but each of them, and the noise's standard deviation."""
    every = range(len(case.effects))
    fewer = tuple(tuple(n for n in every if n != k) for k in every)
    for (*rows, _), level in _quiet(case, (tuple(every), *fewer)):
        yield rows[0], rows[1:], level


def _quiet(case: Case, chosen: Sequence[Sequence[int]]) -> Iterator[tuple[Sequence[FloatArray], FloatArray]]:
    """For every test the samples without noise with the `chosen` effects of the case, and last without drift."""
    base = hidden_machine(case.rng(MACHINE))
    later = base.drifted(case.rng(DRIFT))
    machines = [(later, numbers) for numbers in chosen] + [(base, ())]
    rows = []
    for k in range(1, len(case.speeds_hz) + 1):
        motions = []
        for hidden, numbers in machines:
            machine = changed(_sound(hidden, case), case.effects, case, numbers)
            speed, start = _operation(case, machine, k, "test")
            motions.append(_motion(case, machine, speed, start))
        rows.append(motions)
    ways, _ = _instruments(case, rows[len(rows) // 2][-1])
    heard = [[np.array([through(w, r) for w, r in zip(ways, one, strict=True)]) for one in each] for each in rows]
    level = np.std(heard[len(heard) // 2][-1], axis=1) * 10.0 ** (-case.snr_db / 20.0)
    for each in heard:
        yield each, level


def _sound(hidden: Hidden, case: Case) -> Arrays:
    """The hidden machine of the case without its effects."""
    return case.nominal.sound(hidden, case.torque_nm)


def changed(machine: Arrays, effects: tuple[Hiding, ...], case: Case, numbers: Sequence[int] | None = None) -> Arrays:
    """The machine with its hidden effects, all or those `numbers` (the arrays are changed in place)."""
    for number, hiding in enumerate(effects):
        if numbers is not None and number not in numbers:
            continue
        law = hiding.about()
        site = law.sites.index(hiding.site)
        rng = case.rng(EFFECT, number)
        law.apply(machine, Choice(site=site, value=hiding.value, variant=hiding.variant, rng=rng))
    return machine


def _operation(case: Case, machine: Arrays, k: int, kind: str) -> tuple[Speed, float]:
    return _turning(case, machine, k, case.rng(SPEED, k, int(kind == "test")))


def _turning(case: Case, machine: Arrays, k: int, rng: np.random.Generator) -> tuple[Speed, float]:
    """Speed near the stated one and the angle at the start; slip and cage angles of the run."""
    speed = wandering(case.speeds_hz[k - 1] * (1.0 + rng.uniform(-0.005, 0.005)), rng.uniform(0.001, 0.005), rng)
    slip_free = machine.bearings[:, B.SLIP] == 0.0
    machine.bearings[slip_free, B.SLIP] = rng.uniform(0.0, 0.02, 4)[slip_free]
    machine.bearings[:, B.CAGE] = rng.uniform(0.0, 6.28, 4)
    return speed, float(rng.uniform(0.0, 500.0))


def _motion(case: Case, machine: Arrays, speed: Speed, start: float) -> FloatArray:
    dofs = tuple({"y": Y_DOFS, "x": X_DOFS}[s[-1]][int(s[7]) - 1] for s in case.sensors)
    fine = accelerations(machine, speed, duration_s=DURATION_S, start_rad=start, dofs=dofs)
    return sampled(fine, OVERSAMPLING)


def _instruments(case: Case, reference: FloatArray) -> tuple[list[Way], list[Noise]]:
    """Transfer path and noise of every sensor, the same in all recordings; noise by the reference recording."""
    ways, noises = [], []
    for channel, row in enumerate(reference):
        way = random_path(case.rng(SENSORS, channel))
        level = float(np.std(through(way, row))) * 10.0 ** (-case.snr_db / 20.0)
        ways.append(way)
        noises.append(random_noise(level, case.rng(SENSORS, channel, 1)))
    return ways, noises


def _plugged(
    case: Case, name: str, samples: FloatArray, ways: list[Way], noises: list[Noise], speed: Speed, start: float
) -> FloatArray:
    kind, k = name.split("_")
    rng = case.rng(NOISE, int(k), int(kind == "test"))
    rows = [through(w, row) + n.draw(row.size, rng) for w, n, row in zip(ways, noises, samples, strict=True)]
    found = np.array(rows)
    if case.fault is not None and kind == "test":
        channel, other = fault_place(case)
        t = np.arange(found.shape[1]) / RATE_HZ
        place = Place(channel=channel, other=other, phi=start + speed.angle(t))
        spoil(found, case.fault, place, case.rng(FAULT, 1))
    return found


def write_recording(path: Path, case: Case, speed_hz: float, samples: FloatArray) -> None:
    """`path`.npz and its description `path`.json."""
    channels = [
        {
            "name": f"resonator{s[7]}.y.acceleration" if s.endswith("y") else f"bearing{s[7]}.outer.x.acceleration",
            "column": f"a{i}",
            "quantity": "acceleration",
            "unit": "m/s^2",
            "location": s[:8],
            "axis": s[-1],
        }
        for i, s in enumerate(case.sensors, 1)
    ]
    about = {
        "sampling_rate_hz": RATE_HZ,
        "channels": channels,
        "operating": {"shaft": "input", "speed_hz": speed_hz, "torque_nm": case.torque_nm},
        "condition": "baseline" if path.name.startswith("baseline") else "unknown",
        "notes": "",
    }
    columns = {f"a{i}": row.astype(np.float32) for i, row in enumerate(samples, 1)}
    with path.with_suffix(".npz").open("wb") as stream:
        np.savez(stream, allow_pickle=False, **columns)
    path.with_suffix(".json").write_text(canonical(about), encoding="utf-8")
