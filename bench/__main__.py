"""`python -m bench`: all benchmarks on one core, tables, and one last line `BENCH {json}`."""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # one core is what is promised; must be set before numpy is imported

import argparse  # noqa: E402
import json  # noqa: E402

from bench.cases import CHANNELS, START_S, cases  # noqa: E402
from bench.dataset import SCARCE, SCARCE_LOOPED, datasets  # noqa: E402
from bench.ensemble import MEMBERS, ensemble, prices  # noqa: E402
from bench.precision import STRETCH_S, our_rows, scipy_rows  # noqa: E402
from bench.process import cold_first_step_s, fresh_compile_s, peak_memory_mb  # noqa: E402
from bench.service import service_times_ms  # noqa: E402
from bench.single import LIMIT, LONG_S, lsoda, ours  # noqa: E402

RATIOS = ("lsoda_ratio", "lsoda_odeint_ratio", "lsoda_ratio_at_limit", "lsoda_odeint_ratio_at_limit")


def singles() -> dict[str, float | None]:
    """Speed, error and ratio over the regular cases: lowest, highest, lowest."""
    found = cases()
    print(f"One machine, one core. Reference: {found[0].source}.")
    print(f"Times are CPU seconds of one thread (load of the machine now: {os.getloadavg()[0]:.1f}).")
    print(f"Error: relative L2 of the worst of {len(CHANNELS)} unfiltered sensor accelerations, t >= {START_S} s.")
    print(f"Ours: whole calls of {LONG_S:g} s, assembly included, compile excluded.")
    print("LSODA: compiled right-hand side, the fastest tolerances tried that reach the same error as ours.")
    print("(a) through solve_ivp, SciPy's own recommendation; (b) through odeint, whose loop is compiled;")
    print(f"(c) and (d): the same two when an error of {LIMIT:g} is enough for LSODA, however small ours is.\n")
    names = ("error", "(a)", "(b)", "(c)", "(d)")
    print(f"{'case':32s}{'ours':>22s}{'x real':>8s}{'error':>10s}   LSODA:" + "".join(f"{n:>9s}" for n in names))
    factors, errors = [], []
    ratios: dict[str, list[float]] = {name: [] for name in RATIOS}
    for case in found:
        mine = ours(case)
        same, enough = lsoda(case, mine.error)
        factors.append(mine.factor)
        errors.append(mine.error)
        costs = [c for one in (same, enough) for c in ((one.stepwise, one.cost) if one else (None, None))]
        row = [None if c is None else c / mine.cost for c in costs]
        for name, ratio in zip(RATIOS, row, strict=True):
            ratios[name] += [] if ratio is None else [ratio]
        cells = "".join("        -" if ratio is None else f"{ratio:9.1f}" for ratio in row)
        error = f"{same.error:9.1e}" if same else "        -"
        line = f"{case.name:32s}{mine.how:>22s}{mine.factor:8.2f}{mine.error:10.1e}"
        print(f"{line}         {error}{cells}   {same.how if same else 'no tolerance tried reaches our error'}")
    result: dict[str, float | None] = {"single_realtime_factor": min(factors), "single_error": max(errors)}
    return result | {name: min(found, default=None) for name, found in ratios.items()}


def work_precision(which: tuple[int, ...] = (1, 3)) -> None:
    """Tables of cost and error."""
    found = cases()
    for index in which:
        case = found[min(index, len(found) - 1)]
        print(f"\nWork and precision, {case.name}, SciPy on {STRETCH_S} s with the compiled right-hand side")
        print(f"{'method':12s}{'how':>14s}{'s per s':>12s}{'error':>12s}")
        for method, row in our_rows(case) + scipy_rows(case):
            print(f"{method:12s}{row.how:>14s}{row.cost:12.3f}{row.error:12.1e}")


def ensembles(*, with_prices: bool) -> dict[str, float | None]:
    """Speed of many machines in one call, and what each effect costs."""
    found = ensemble()
    print(f"\n{MEMBERS} machines with different parameters in one call, one core (gearbox with clearance, 30 kHz):")
    print(f"{found.factor:.1f} simulated seconds per core-second, worst error {found.error:.1e},")
    print(f"{found.speedup:.2f} times faster than one machine at a time")
    if with_prices:
        print("\nPrice of an effect: cost of a run with it over one without, on the machine of its demonstration")
        print(f"{'effect':28s}{'machine':>24s}{'alone':>8s}{'in lanes':>10s}")
        for price in prices():
            print(f"{price.key:28s}{price.machine:>24s}{price.single:8.2f}{price.lanes:10.2f}")
    return {
        "ensemble_realtime_factor_per_core": found.factor,
        "ensemble_error": found.error,
        "ensemble_vs_single_speedup": found.speedup,
    }


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


def service() -> dict[str, float]:
    """What the service adds to a simulation."""
    accept_ms, overhead_ms = service_times_ms()
    print(f"\nService, medians: a submission takes {accept_ms:.1f} ms, a job {overhead_ms:.0f} ms beyond simulating")
    return {"api_accept_p50_ms": accept_ms, "job_overhead_ms": overhead_ms}


def main() -> None:
    """Run what is asked for; everything by default."""
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="only speed, error and ratio; a small dataset")
    parser.add_argument("--only", choices=("dataset",), help="nothing but the rows per second of a dataset")
    parser.add_argument("--rows", type=int, default=None, metavar="N", help="of the dataset, instead of its default")
    parser.add_argument("--looped", type=int, default=None, metavar="N", help="rows of its plain loop (as many)")
    given = parser.parse_args()
    result: dict[str, float | None] = {}
    if given.only is None:
        result |= singles()
        result |= ensembles(with_prices=not given.quick)
        if not given.quick:
            work_precision()
            result |= processes()
            result |= service()
    rows, looped = (None, None) if given.only or given.quick else (SCARCE, SCARCE_LOOPED)
    result |= datasets(quick=given.quick, rows=given.rows or rows, looped_rows=given.looped or looped)
    rounded = {name: None if value is None else float(f"{value:.4g}") for name, value in result.items()}
    print("\nBENCH " + json.dumps(rounded))


if __name__ == "__main__":
    main()
