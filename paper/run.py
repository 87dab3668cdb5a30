"""Runs of the study: simulate, measure, cache."""

from __future__ import annotations

import hashlib
import json
import math
import multiprocessing
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import numpy as np

from paper.cases import Case, machine
from paper.measure.all import measures
from paper.measure.mean import PairLaw
from paper.measure.window import FloatArray, Window
from sim.assembly.laws import base_laws
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.version import PHYSICS_VERSION

LEAST_RATE_HZ = 60_000.0
SETTLING_S = 0.25
"""Longest transient seen is 0.17 s (preset `paper`, healthy)."""
REVOLUTIONS = 24
"""Analysed revolutions; f_o1 lines are read after every shaft multiple is removed, so f_m does not leak into 9 f_o1."""
TRACE_REVOLUTIONS = 4
CHANNELS: Mapping[str, str] = {
    "k": "mesh1.stiffness",
    "a": "mesh1.centre_distance_error",
    "theta": "mesh1.offset_angle",
    "y": "resonator1.y.displacement",
    "acc": "resonator1.y.acceleration",
    "ring_x": "bearing1.inner.x.displacement",
    "ring_y": "bearing1.inner.y.displacement",
}


@dataclass(frozen=True, kw_only=True)
class Result:
    """Measures of a case, the last revolutions of its signals (`trace`) and its acceleration spectrum to 8 kHz."""

    case: Case
    numbers: Mapping[str, float]
    trace: Mapping[str, FloatArray]
    trace_rate_hz: float
    spectrum: FloatArray
    spectrum_resolution_hz: float


def run(case: Case) -> tuple[Window, Response]:
    """Simulate a case and cut its settled revolutions out. No anti-alias filter: it would ring at stiffness jumps."""
    spec = machine(case)
    teeth = spec.gears[0].teeth
    per_mesh = math.ceil(LEAST_RATE_HZ / (teeth * case.speed_hz) - 1e-9)
    rate = per_mesh * teeth * case.speed_hz
    skipped = math.ceil(SETTLING_S * case.speed_hz)
    response = simulate(
        spec,
        duration_s=(skipped + REVOLUTIONS) / case.speed_hz,
        output_rate_hz=rate,
        channels=tuple(CHANNELS.values()),
        settings=Settings(estimate_error=False, anti_alias=False),
    )
    start = skipped * per_mesh * teeth
    stop = start + REVOLUTIONS * per_mesh * teeth
    signals = {short: response.signal(name)[start:stop] for short, name in CHANNELS.items()}
    window = Window(
        signals=signals,
        per_mesh=per_mesh,
        teeth=teeth,
        f_r1_hz=case.speed_hz,
        f_o1_hz=response.bases_hz["f_o1"],
    )
    return window, response


@cache
def _law_of(gears_and_meshes: str) -> PairLaw:
    law = next(iter(base_laws(MachineSpec.model_validate_json(gears_and_meshes), {}, []).meshes.values()))
    assert law.pair_rows is not None  # the presets' meshes are sums over tooth pairs
    assert law.pair_ratios is not None
    return PairLaw(
        errors_m=law.centre_errors_m, contact_ratio=law.pair_ratios, stiffness_n_per_m=np.asarray(law.pair_rows)[0]
    )


def pair_law(spec: MachineSpec) -> PairLaw | None:
    """Stiffness of a tooth pair of the machine; None where the offset angle acts on it too."""
    if any(m.offset_angle for m in spec.meshes):
        return None
    parts = MachineSpec(name="mesh", shafts=spec.shafts, gears=spec.gears, meshes=spec.meshes)
    return _law_of(parts.model_dump_json())


def result_of(case: Case) -> Result:
    """Simulate and measure."""
    window, response = run(case)
    numbers = measures(window, pair_law(response.machine))
    quality = response.quality
    numbers |= {
        "f_o1_hz": window.f_o1_hz,
        "unconverged": float(quality.unconverged_steps),
        "energy_residual": quality.energy.relative_residual,
        "wall_contact": response.contact_share.get("bearing1.wall", 1.0),
    }
    keep = TRACE_REVOLUTIONS * window.per_revolution
    acc = window.signals["acc"]
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(acc.size) / acc.size)
    spectrum = 2.0 * np.abs(np.fft.rfft((acc - acc.mean()) * hann)) / hann.sum()
    resolution = window.rate_hz / acc.size
    return Result(
        case=case,
        numbers=numbers,
        trace={name: values[-keep:] for name, values in window.signals.items()},
        trace_rate_hz=window.rate_hz,
        spectrum=spectrum[: int(8000 / resolution)],
        spectrum_resolution_hz=resolution,
    )


def _code_digest() -> str:
    """Digest of the measuring code: a changed measure must not read old numbers."""
    here = Path(__file__).parent
    files = [*sorted((here / "measure").glob("*.py")), here / "run.py"]
    return hashlib.sha256(b"".join(f.read_bytes() for f in files)).hexdigest()[:16]


def cache_path(folder: Path, case: Case) -> Path:
    """Place of a case: its machine, the version of the physics and the measuring code."""
    spec = machine(case).model_dump_json()
    key = json.dumps([spec, asdict(case), PHYSICS_VERSION, _code_digest()], sort_keys=True)
    return folder / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.npz"


def load(path: Path, case: Case) -> Result | None:
    """A cached result, or None."""
    if not path.exists():
        return None
    with np.load(path) as data:
        return Result(
            case=case,
            numbers=json.loads(str(data["numbers"])),
            trace={name: data[f"trace_{name}"].astype(np.float64) for name in CHANNELS},
            trace_rate_hz=float(data["rate"]),
            spectrum=data["spectrum"].astype(np.float64),
            spectrum_resolution_hz=float(data["resolution"]),
        )


def save(path: Path, result: Result) -> None:
    """Write atomically; traces in single precision are enough for pictures."""
    part = path.with_name(f"{path.stem}.{os.getpid()}.part.npz")
    traces = {f"trace_{n}": v.astype(np.float32) for n, v in result.trace.items()}
    np.savez(
        part,
        allow_pickle=False,
        numbers=np.array(json.dumps(dict(result.numbers))),
        rate=np.array(result.trace_rate_hz),
        spectrum=result.spectrum.astype(np.float32),
        resolution=np.array(result.spectrum_resolution_hz),
        **traces,
    )
    part.replace(path)


def _work(job: tuple[str, Case]) -> str:
    path, case = job
    save(Path(path), result_of(case))
    return path


def results(
    cases: Iterable[Case], *, folder: Path, fresh: bool, processes: int, progress: Callable[[int, int], None]
) -> dict[Case, Result]:
    """Results of all cases, simulating what the cache lacks in `processes` worker processes."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = list(dict.fromkeys(cases))
    paths = {case: cache_path(folder, case) for case in wanted}
    missing = [(str(paths[c]), c) for c in wanted if fresh or not paths[c].exists()]
    if missing:
        for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
            os.environ.setdefault(name, "1")  # spawned workers read it: two of them share the cores already
        with multiprocessing.get_context("spawn").Pool(processes) as pool:
            for done, _ in enumerate(pool.imap_unordered(_work, missing, chunksize=2), 1):
                progress(done, len(missing))
    found = {case: load(paths[case], case) for case in wanted}
    return {case: result for case, result in found.items() if result is not None}
