"""Trends 7 and 8: the speed sweep and the comparison with the experiment, all at 20 um."""

from __future__ import annotations

from paper.verdict.mesh import LEAST_SHARE, dominated
from paper.verdict.rules import Judgement, Verdict, both, count, falls, rank, rises, share, shown
from paper.verdict.sweep import Sweep

SIDE_ORDERS = (1, 2, 3, 4, 5)
SHOWN_UM = 20.0


def with_speed(sweep: Sweep, name: str, *, up: bool = True, power: int = 0) -> Judgement:
    """A number against speed; `power` 2 turns a line of acceleration into one of displacement."""
    values = [v / hz**power for v, hz in zip(sweep.fast(name), sweep.by_speed, strict=True)]
    verdict = rises(values) if up else falls(values)
    text = f"{shown(values)} at {shown(list(sweep.by_speed))} Hz; rank {rank(values):.2f}"
    return Judgement(verdict=verdict, numbers=text)


def multiples_fall(sweep: Sweep, power: int) -> Judgement:
    """2..5 f_m against speed: how many fall."""
    verdicts = [with_speed(sweep, f"fm{j}", up=False, power=power).verdict for j in (2, 3, 4, 5)]
    ends = []
    for j in (2, 3, 4, 5):
        row = [v / hz**power for v, hz in zip(sweep.fast(f"fm{j}"), sweep.by_speed, strict=True)]
        ends.append(row[-1] / row[0])
    good = share([v == "reproduced" for v in verdicts])
    some = share([v != "not" for v in verdicts])
    verdict: Verdict = "not" if some == "not" else both(good, some) if good != "not" else "partly"
    return Judgement(verdict=verdict, numbers=f"2..5 f_m, 60 Hz over 10 Hz: x {shown(ends)}")


def sidebands_stay_low(sweep: Sweep) -> Judgement:
    """At the highest speed f_m +- f_r1 and 2f_m +- f_r1 stand out and those of 3..5 f_m do not."""
    last = list(sweep.by_speed.values())[-1]
    on = {j: last[f"fm{j}-r_on"] + last[f"fm{j}+r_on"] for j in SIDE_ORDERS}
    low, high = on[1] + on[2], on[3] + on[4] + on[5]
    verdict: Verdict = "not" if low == 0 else "reproduced" if low >= 3 and high == 0 else "partly"
    text = f"sidebands present at {list(sweep.by_speed)[-1]:g} Hz: {low:g} of 4 (f_m, 2f_m), {high:g} of 6 (3..5 f_m)"
    return Judgement(verdict=verdict, numbers=text)


def experiment_lines(sweep: Sweep, names: tuple[str, ...]) -> Judgement:
    """Lines of Figure 16 at 20 um."""
    numbers = sweep.by_gap[sweep.nearest(SHOWN_UM)]
    found = [n for n in names if numbers[f"{n}_on"] > 0]
    share_of_top = [numbers[n] / numbers["largest_line"] for n in names]
    text = f"{len(found)} of {len(names)} present; share of the largest line {shown(share_of_top, digits=2)}"
    return Judgement(verdict=count(len(found), len(names)), numbers=text)


def shocks_at_f_o1(sweep: Sweep) -> Judgement:
    """Range of the acceleration a mesh period, dominated by f_o1 at 20 um."""
    numbers = sweep.by_gap[sweep.nearest(SHOWN_UM)]
    good = dominated(numbers, "acc_env", sweep.f_o1_hz, sweep.f_r1_hz / 24.0, LEAST_SHARE)
    depth = numbers["acc_env_at_f_o1"] / numbers["acc_env_scale"]
    text = f"largest line of the envelope at {numbers['acc_env_largest_hz']:.4g} Hz; f_o1 line / range {depth:.2g}"
    return Judgement(verdict="reproduced" if good else "not", numbers=text)
