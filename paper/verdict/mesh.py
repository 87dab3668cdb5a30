"""Trends 1 and 2: centre distance, offset angle, mesh stiffness."""

from __future__ import annotations

from paper.verdict.rules import LEAST_CHANGE, MOST, Judgement, Verdict, both, change, falls, rank, rises, share, shown
from paper.verdict.sweep import Numbers, Sweep

LEAST_SHARE = 1e-3
"""Modulation below this share of the signal's range is invisible in a plot."""
LEAST_STIFFNESS_SHARE = 1e-4
"""For the stiffness, relative to its mean: 1e-4 is a fiftieth of the line's width in a plot."""
WIDTH_BINS = 1.5
FIRST_GAP = 10.0
"""Smallest clearance the paper draws, um."""
LEAST_ADVANCE_DEG = 2.0
CHANCE = 0.16
"""Share of a mesh period that counts as near one of two jumps: extremes strewn at random would give this."""


def dominated(numbers: Numbers, name: str, f_o1_hz: float, resolution_hz: float, least: float) -> bool:
    """Whether f_o1 is the largest line of a slow curve and large enough to be seen."""
    near = abs(numbers[f"{name}_largest_hz"] - f_o1_hz) <= WIDTH_BINS * resolution_hz
    return near and numbers[f"{name}_at_f_o1"] >= least * numbers[f"{name}_scale"]


def modulated(sweep: Sweep, name: str, least: float = LEAST_SHARE) -> Judgement:
    """Slow curve dominated by f_o1 over the clearances from 10 um on."""
    gaps = sweep.gaps(FIRST_GAP)
    resolution = sweep.f_r1_hz / 24.0
    hits = [dominated(sweep.by_gap[g], name, sweep.f_o1_hz, resolution, least) for g in gaps]
    depth = [sweep.by_gap[g][f"{name}_at_f_o1"] / max(sweep.by_gap[g][f"{name}_scale"], 1e-300) for g in gaps]
    largest = [sweep.by_gap[g][f"{name}_largest_hz"] for g in gaps]
    text = f"largest line at {shown(largest)} Hz; f_o1 line / scale {shown(depth, digits=2)}"
    return Judgement(verdict=share(hits), numbers=text)


def depth_grows(sweep: Sweep, name: str) -> Judgement:
    """Amplitude of the slow f_o1 line against clearance, from the healthy machine."""
    values = sweep.row(f"{name}_at_f_o1", [0.0, *sweep.gaps(FIRST_GAP)])
    text = f"f_o1 line healthy then 10..50 um: {shown(values)}; rank {rank(values):.2f}"
    return Judgement(verdict=rises(values), numbers=text)


def phase_advances(sweep: Sweep) -> Judgement:
    """Phase of the f_m line of the centre-distance error, unwrapped along the clearance."""
    raw = sweep.row("a_fm_phase_deg", sweep.gaps())
    phases = [raw[0]]
    for value in raw[1:]:
        phases.append(phases[-1] + (value - phases[-1] + 180.0) % 360.0 - 180.0)
    net, steady = phases[-1] - phases[0], rank(phases)
    verdict: Verdict = "not"
    if net >= LEAST_ADVANCE_DEG:
        verdict = "reproduced" if steady >= 0.9 else "partly"
    return Judgement(verdict=verdict, numbers=f"{shown(phases)} deg; net {net:.3g}, rank {steady:.2f}")


def angle_grows_more(sweep: Sweep) -> Judgement:
    """Growth of the peaks from 1 um to 50 um (a symmetric healthy machine has no offset angle at all)."""
    gaps = sweep.gaps()
    ratios = [sweep.row(f"{n}_peak", gaps)[-1] / sweep.row(f"{n}_peak", gaps)[0] for n in ("a", "theta")]
    verdict: Verdict = "not"
    if ratios[1] > ratios[0]:
        verdict = "reproduced" if ratios[1] > 1.05 else "partly"
    peaks = sweep.row("theta_peak", [0.0, gaps[0], gaps[-1]])
    text = f"peak x{ratios[0]:.3g} (centre distance), x{ratios[1]:.3g} (angle: {shown(peaks)} rad at healthy, ends)"
    return Judgement(verdict=verdict, numbers=text)


def stiffness_reduced(sweep: Sweep) -> Judgement:
    """Mean stiffness against the healthy machine."""
    healthy = sweep.healthy["k_mean"]
    parts = [v / healthy - 1.0 for v in sweep.row("k_mean", sweep.gaps(FIRST_GAP))]
    lower = share([p < 0 for p in parts])
    visible = share([p < -LEAST_STIFFNESS_SHARE for p in parts])
    verdict: Verdict = "not" if lower == "not" else both(lower, visible)
    return Judgement(verdict=verdict, numbers=f"mean against healthy {shown(parts, 1e6)} ppm")


def extremes_at_ends(sweep: Sweep) -> Judgement:
    """Local extremes beyond the healthy machine's, near the ends of the single- and double-tooth intervals."""
    gaps = sweep.gaps(FIRST_GAP)
    near, found = sweep.row("k_extremes_near", gaps), sweep.row("k_extremes", gaps)
    more = [f > (1 + LEAST_CHANGE) * sweep.healthy["k_extremes"] for f in found]
    gathered: Verdict = "reproduced" if min(near) > MOST else "partly" if min(near) > 2 * CHANCE else "not"
    verdict: Verdict = "not" if not any(more) else gathered
    text = f"{shown(found)} a mesh period (healthy {sweep.healthy['k_extremes']:.3g}); near a jump {shown(near)}"
    return Judgement(verdict=verdict, numbers=text)


def extremes_grow(sweep: Sweep) -> Judgement:
    """Number of local extremes a mesh period."""
    values = sweep.row("k_extremes", [0.0, *sweep.gaps(FIRST_GAP)])
    return Judgement(verdict=rises(values), numbers=f"{shown(values)} a mesh period, healthy then 10..50 um")


def minimum_falls(sweep: Sweep) -> Judgement:
    """Single-tooth minimum at 10, 20, 30 um."""
    values = sweep.row("k_min", [sweep.nearest(g) for g in (10.0, 20.0, 30.0)])
    net = change(values)
    verdict = falls(values, least=LEAST_STIFFNESS_SHARE)
    return Judgement(verdict=verdict, numbers=f"{shown(values, 1e-8, 7)} e8 N/m; net {net * 1e6:.3g} ppm")
