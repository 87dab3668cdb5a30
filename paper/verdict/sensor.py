"""Trends 3 to 6: displacement, spectrum, line amplitudes, orbit."""

from __future__ import annotations

from itertools import pairwise
from statistics import median

from paper.measure.sensor import MESH_ORDERS, OUTER_ORDERS
from paper.verdict.mesh import FIRST_GAP
from paper.verdict.rules import Judgement, Verdict, both, change, count, falls, rank, rises, share, shown
from paper.verdict.sweep import Numbers, Sweep

DRAWN_UM = (10.0, 30.0, 50.0)
TURN_UM = 5.0
TOP_UM = 45.0
SETTLED_UM = 15.0


def drawn(sweep: Sweep, name: str, unit_scale: float = 1e6) -> Judgement:
    """A number at the clearances Figure 9 draws."""
    values = sweep.row(name, [sweep.nearest(g) for g in DRAWN_UM])
    return Judgement(verdict=rises(values), numbers=f"{shown(values, unit_scale)} at 10, 30, 50 um")


def lines_present(sweep: Sweep, names: tuple[str, ...]) -> Judgement:
    """Median over the clearances from 10 um on of how many of the lines stand out; all at some clearance: partly."""
    counts = [sum(sweep.by_gap[g][f"{n}_on"] for n in names) for g in sweep.gaps(FIRST_GAP)]
    wanted = len(names)
    verdict = count(median(counts), wanted)
    if verdict == "not" and max(counts) >= wanted:
        verdict = "partly"
    return Judgement(verdict=verdict, numbers=f"{shown(counts)} of {wanted} at 10..50 um")


def orders_present(numbers: Numbers) -> int:
    """How many of f_o1 x 1..20 and f_m x 1..7 stand out."""
    names = [f"fo{k}" for k in OUTER_ORDERS] + [f"fm{j}" for j in MESH_ORDERS]
    return int(sum(numbers[f"{n}_on"] for n in names))


def orders_appear(sweep: Sweep) -> Judgement:
    """Number of present orders against clearance, and the summed amplitude of the high ones."""
    gaps = [0.0, *sweep.gaps()]
    found = [float(orders_present(sweep.by_gap[g] if g > 0 else sweep.healthy)) for g in gaps]
    return Judgement(verdict=rises(found), numbers=f"orders present {shown(found)} at 0, {shown(gaps[1:])} um")


def high_orders_grow(sweep: Sweep) -> Judgement:
    """Summed amplitude of 4..7 f_m against clearance."""
    gaps = [0.0, *sweep.gaps()]
    columns = [sweep.row(f"fm{j}", gaps) for j in (4, 5, 6, 7)]
    values = [sum(v) for v in zip(*columns, strict=True)]
    return Judgement(verdict=rises(values), numbers=f"sum of 4..7 f_m {shown(values)} m/s^2; rank {rank(values):.2f}")


def side_bands_grow(sweep: Sweep) -> Judgement:
    """Summed amplitude of the present sidebands of 4..7 f_m against clearance."""
    gaps = [0.0, *sweep.gaps()]
    values = []
    for g in gaps:
        numbers = sweep.by_gap[g] if g > 0 else sweep.healthy
        names = [f"fm{j}{s}r" for j in (4, 5, 6, 7) for s in "-+"]
        values.append(sum(numbers[n] * numbers[f"{n}_on"] for n in names))
    verdict: Verdict = "not" if max(values) == 0.0 else rises(values)
    return Judgement(verdict=verdict, numbers=f"present sidebands of 4..7 f_m, sum {shown(values)} m/s^2")


def peak_near(sweep: Sweep, name: str, *, at_um: float, tolerance_um: float, lowest: bool = False) -> Judgement:
    """Where a line has its maximum (or minimum), from the healthy machine to the end of the sweep.

    A maximum at the healthy machine is none; one at the end of the sweep is at best partly one.
    """
    gaps = [0.0, *sweep.gaps()]
    values = sweep.row(name, gaps)
    place = gaps[values.index(min(values) if lowest else max(values))]
    distance = abs(place - at_um)
    inner = gaps[0] < place < gaps[-1]
    verdict: Verdict = "not"
    if inner and distance <= tolerance_um:
        verdict = "reproduced"
    elif place > gaps[0] and distance <= 2 * tolerance_um:
        verdict = "partly"
    kind = "minimum" if lowest else "maximum"
    return Judgement(verdict=verdict, numbers=f"{kind} at {place:g} um; {shown(values)} at 0, {shown(gaps[1:])} um")


def moves(sweep: Sweep, name: str, *, low: float, high: float, up: bool) -> Judgement:
    """Whether a line rises (or falls) between two clearances; 0 is the healthy machine."""
    gaps = ([0.0] if low == 0.0 else []) + sweep.gaps(low, high)
    values = sweep.row(name, gaps)
    verdict = rises(values) if up else falls(values)
    text = f"{shown(values)} at {shown(gaps)} um; net {change(values):+.0%}, rank {rank(values):.2f}"
    return Judgement(verdict=verdict, numbers=text)


def second_exceeds(sweep: Sweep) -> Judgement:
    """2 f_m above f_m beyond 5 um (acceleration; in displacement its share is a quarter)."""
    gaps = [g for g in sweep.gaps() if g > TURN_UM]
    ratio = [b / a for a, b in zip(sweep.row("fm1", gaps), sweep.row("fm2", gaps), strict=True)]
    text = f"2f_m / f_m {shown(ratio)} in acceleration at {shown(gaps)} um (a quarter of it in displacement)"
    return Judgement(verdict=share([r > 1 for r in ratio]), numbers=text)


def after_top(sweep: Sweep) -> Judgement:
    """From 45 to 50 um f_m and 2 f_m fall while 3..7 f_m rise."""
    gaps = [sweep.nearest(TOP_UM), sweep.nearest(50.0)]
    steps = {j: change(sweep.row(f"fm{j}", gaps)) for j in MESH_ORDERS}
    low = share([steps[1] < 0, steps[2] < 0])
    high = share([steps[j] > 0 for j in (3, 4, 5, 6, 7)])
    verdict: Verdict = "not" if "not" in (low, high) else both(low, high)
    text = "change 45 to 50 um of 1..7 f_m: " + ", ".join(f"{v:+.0%}" for v in steps.values())
    return Judgement(verdict=verdict, numbers=text)


def irregular_then_growing(sweep: Sweep) -> tuple[Judgement, Judgement]:
    """f_o1: turns below 15 um; growth from 15 um on."""
    small = sweep.row("fo1", [0.0, *[g for g in sweep.gaps() if g <= SETTLED_UM]])
    steps = [b - a for a, b in pairwise(small)]
    turns = sum(a * b < 0 for a, b in pairwise(steps))
    text = f"f_o1 {shown(small)} m/s^2 at 0..15 um, {turns} turns"
    irregular: Verdict = "reproduced" if turns >= 2 else "partly" if turns else "not"
    return Judgement(verdict=irregular, numbers=text), moves(sweep, "fo1", low=SETTLED_UM, high=1e9, up=True)


def fundamental_largest(sweep: Sweep) -> Judgement:
    """f_o1 the largest of its family from 15 um on (displacement weighs order k by 1/k^2)."""
    gaps = sweep.gaps(SETTLED_UM)
    by_gap = [[sweep.by_gap[g][f"fo{k}"] for k in OUTER_ORDERS] for g in gaps]
    in_acc = share([max(v) == v[0] for v in by_gap])
    in_disp = share([max(x / k**2 for k, x in zip(OUTER_ORDERS, v, strict=True)) == v[0] for v in by_gap])
    largest = [1 + v.index(max(v)) for v in by_gap]
    text = f"largest order in acceleration {shown(largest)}; largest in displacement is the first: {in_disp}"
    return Judgement(verdict=both(in_acc, in_disp), numbers=text)


def orbit_widens(sweep: Sweep) -> Judgement:
    """Width of the orbit in x and in y against clearance."""
    gaps = [0.0, *sweep.gaps()]
    x, y = sweep.row("orbit_x", gaps), sweep.row("orbit_y", gaps)
    text = f"x {shown(x, 1e6)}; y {shown(y, 1e6)} um at 0, {shown(gaps[1:])} um"
    return Judgement(verdict=both(rises(x), rises(y)), numbers=text)


def more_in_y(sweep: Sweep) -> Judgement:
    """Growth of the orbit from healthy to the largest clearance, y against x."""
    gap = sweep.gaps()[-1]
    dx, dy = (sweep.by_gap[gap][f"orbit_{a}"] - sweep.healthy[f"orbit_{a}"] for a in "xy")
    verdict: Verdict = "not" if dy <= 0 or dy <= dx else "reproduced"
    return Judgement(verdict=verdict, numbers=f"widening healthy to {gap:g} um: x {dx * 1e6:.3g}, y {dy * 1e6:.3g} um")


def moves_away(sweep: Sweep) -> Judgement:
    """Largest distance from the bearing's centre, static part included, against clearance: both grow, y more."""
    gaps = [0.0, *sweep.gaps()]
    x, y = sweep.row("reach_x", gaps), sweep.row("reach_y", gaps)
    grown = rises(y)
    verdict: Verdict = grown if y[-1] - y[0] > x[-1] - x[0] else "not"
    if rises(x) == "not" and verdict == "reproduced":
        verdict = "partly"
    text = f"farthest in x {shown(x, 1e6)}; in y {shown(y, 1e6)} um at 0, {shown(gaps[1:])} um"
    return Judgement(verdict=verdict, numbers=text)


def peaks_grow(sweep: Sweep) -> Judgement:
    """Peaks of the orbit's radius in a revolution."""
    values = sweep.row("orbit_peaks", [0.0, *sweep.gaps()])
    return Judgement(verdict=rises(values), numbers=f"{shown(values)} a revolution (23 are the teeth)")
