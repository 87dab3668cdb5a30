"""Fresh processes: time to the first step with and without compiled kernels on disk, and peak memory."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FIRST_STEP = """
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
s = Settings(anti_alias=False, estimate_error=False, steps_per_output=1)
simulate(preset("paper-demo"), duration_s=2 / 30000, output_rate_hz=30000.0, settings=s)
print("done", flush=True)
"""
MEMORY = """
import resource, sys
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
r = simulate(preset("paper-demo"), duration_s=float(sys.argv[1]), output_rate_hz=12000.0,
             settings=Settings(estimate_error=False))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, r.signals.nbytes / 2**20)
"""


def _first_step(cache: str | None) -> float:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    if cache is not None:
        environment["SIDEBAND_CACHE"] = cache
    start = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-c", FIRST_STEP], stdout=subprocess.PIPE, env=environment, cwd=ROOT, text=True
    ) as child:
        assert child.stdout is not None
        line = child.stdout.readline()
        elapsed = time.perf_counter() - start
    if line.strip() != "done":
        raise RuntimeError("the fresh process did not take its first step")
    return elapsed


def cold_first_step_s(repeats: int = 5) -> float:
    """From process start to the first step done, kernels on disk: median, s."""
    _first_step(None)
    return statistics.median(_first_step(None) for _ in range(repeats))


def fresh_compile_s() -> float:
    """The same with an empty cache: everything is compiled, s."""
    with tempfile.TemporaryDirectory() as folder:
        return _first_step(folder)


def peak_memory_mb(duration_s: float) -> tuple[float, float]:
    """Peak resident memory of a run in its own process, and the size of its signals, MiB."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    out = subprocess.run(
        [sys.executable, "-c", MEMORY, str(duration_s)],
        stdout=subprocess.PIPE,
        env=environment,
        cwd=ROOT,
        check=True,
        text=True,
    ).stdout
    peak, signals = out.split()
    return float(peak), float(signals)
