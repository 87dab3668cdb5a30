"""`python -m bench`: all benchmarks on one core, tables, and one last line `BENCH {json}`."""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # one core is what is promised; must be set before numpy is imported

import argparse  # noqa: E402
import json  # noqa: E402

from bench.cases import CHANNELS, START_S, cases  # noqa: E402
from bench.precision import STRETCH_S, our_rows, scipy_rows  # noqa: E402
from bench.process import cold_first_step_s, fresh_compile_s, peak_memory_mb  # noqa: E402
from bench.service import service_times_ms  # noqa: E402
from bench.single import LIMIT, LONG_S, lsoda, ours  # noqa: E402


def singles() -> dict[str, float | None]:
    """Speed, error and ratio over the regular cases: lowest, highest, lowest."""
    found = cases()
    print(f"One machine, one core. Reference: {found[0].source}.")
    print(f"Times are CPU seconds of one thread (load of the machine now: {os.getloadavg()[0]:.1f}).")
    print(f"Error: relative L2 of the worst of {len(CHANNELS)} unfiltered sensor accelerations, t >= {START_S} s.")
    print(f"Ours: whole calls of {LONG_S:g} s, assembly included, compile excluded.")
    print(f"LSODA: compiled right-hand side, whole reference, fastest tolerances with an error <= {LIMIT:g};")
    print("ratio: through odeint, the fastest door; (b): the same tolerances through solve_ivp.\n")
    head = ("LSODA x slower", 16), ("error", 10), ("ratio", 8), ("(b)", 8)
    print(f"{'case':32s}{'ours':>22s}{'x real':>8s}{'error':>10s}" + "".join(f"{name:>{n}s}" for name, n in head))
    factors, errors, ratios, slower = [], [], [], []
    for case in found:
        mine, theirs = ours(case), lsoda(case)
        factors.append(mine.factor)
        errors.append(mine.error)
        line = f"{case.name:32s}{mine.how:>22s}{mine.factor:8.2f}{mine.error:10.1e}"
        if theirs is None:
            print(line + "   no tolerance tried meets the limit")
            continue
        ratios.append(theirs.cost / mine.cost)
        slower.append((theirs.stepwise or theirs.cost) / mine.cost)
        print(line + f"{theirs.cost:16.2f}{theirs.error:10.1e}{ratios[-1]:8.1f}{slower[-1]:8.1f}   {theirs.how}")
    return {
        "single_realtime_factor": min(factors),
        "single_error": max(errors),
        "lsoda_ratio": min(ratios, default=None),
        "lsoda_solve_ivp_ratio": min(slower, default=None),
    }


def work_precision(which: tuple[int, ...] = (1, 3)) -> None:
    """Tables of cost and error."""
    found = cases()
    for index in which:
        case = found[min(index, len(found) - 1)]
        print(f"\nWork and precision, {case.name}, SciPy on {STRETCH_S} s with the compiled right-hand side")
        print(f"{'method':12s}{'how':>14s}{'s per s':>12s}{'error':>12s}")
        for method, row in our_rows(case) + scipy_rows(case):
            print(f"{method:12s}{row.how:>14s}{row.cost:12.3f}{row.error:12.1e}")


def processes() -> dict[str, float]:
    """Start and memory of fresh processes."""
    cold, fresh = cold_first_step_s(), fresh_compile_s()
    print(f"\nFresh process to first step: {cold:.2f} s with kernels on disk, {fresh:.1f} s with an empty cache")
    peaks = {duration: peak_memory_mb(duration) for duration in (2.0, 40.0)}
    for duration, (peak, signals) in peaks.items():
        print(
            f"Peak memory of {duration:g} s at 12 kHz, four channels: {peak:.0f} MiB ({signals:.1f} MiB of it signals)"
        )
    return {"cold_first_step_s": cold, "fresh_compile_s": fresh, "peak_memory_mb": peaks[40.0][0]}


def main() -> None:
    """Run what is asked for; everything by default."""
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="only speed, error and ratio")
    quick = parser.parse_args().quick
    result: dict[str, float | None] = dict(singles())
    if not quick:
        work_precision()
        result |= processes()
        accept_ms, overhead_ms = service_times_ms()
        print(
            f"\nService, medians: a submission takes {accept_ms:.1f} ms, a job {overhead_ms:.0f} ms beyond simulating"
        )
        result |= {"api_accept_p50_ms": accept_ms, "job_overhead_ms": overhead_ms}
    rounded = {name: None if value is None else float(f"{value:.4g}") for name, value in result.items()}
    print("\nBENCH " + json.dumps(rounded))


if __name__ == "__main__":
    main()
