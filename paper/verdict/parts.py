"""Every part of the eight trends: its words and its rule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from paper.measure.sensor import MESH_ORDERS
from paper.verdict import mesh, sensor, speed
from paper.verdict.rules import Judgement
from paper.verdict.sweep import Sweep

SIDEBANDS = tuple(f"fm{j}{s}r" for j in MESH_ORDERS for s in "-+")


@dataclass(frozen=True, kw_only=True)
class Part:
    """One claim of the paper. `needs_speed`: judged on the speed sweep."""

    key: str
    claim: str
    judge: Callable[[Sweep], Judgement]
    needs_speed: bool = False


def _part(key: str, claim: str, judge: Callable[[Sweep], Judgement]) -> Part:
    return Part(key=key, claim=claim, judge=judge, needs_speed=key.startswith("7"))


PARTS: tuple[Part, ...] = (
    _part("1a", "centre distance: envelope at f_o1", lambda s: mesh.modulated(s, "a_env")),
    _part("1b", "offset angle: envelope at f_o1", lambda s: mesh.modulated(s, "theta_env")),
    _part("1c", "depth grows, centre distance", lambda s: mesh.depth_grows(s, "a_env")),
    _part("1d", "depth grows, offset angle", lambda s: mesh.depth_grows(s, "theta_env")),
    _part("1e", "centre distance advances in phase", mesh.phase_advances),
    _part("1f", "peaks grow more in the angle", mesh.angle_grows_more),
    _part("2a", "stiffness reduced on the whole", mesh.stiffness_reduced),
    _part("2b", "stiffness modulated at f_o1", lambda s: mesh.modulated(s, "k_single", mesh.LEAST_STIFFNESS_SHARE)),
    _part("2c", "extremes at the ends of the intervals", mesh.extremes_at_ends),
    _part("2d", "extremes become more", mesh.extremes_grow),
    _part("2e", "single-tooth minimum falls 10, 20, 30 um", mesh.minimum_falls),
    _part("3a", "largest displacement grows", lambda s: sensor.drawn(s, "y_max")),
    _part("3b", "fluctuation grows", lambda s: sensor.drawn(s, "y_range")),
    _part("3c", "median line has the period 1/f_o1", lambda s: mesh.modulated(s, "y_median")),
    _part("3d", "median line's swing grows", lambda s: sensor.drawn(s, "y_median_at_f_o1", 1e9)),
    _part("4a", "10, 11, 12, 18 f_o1", lambda s: sensor.lines_present(s, ("fo10", "fo11", "fo12", "fo18"))),
    _part("4b", "1..7 f_m", lambda s: sensor.lines_present(s, tuple(f"fm{j}" for j in MESH_ORDERS))),
    _part("4c", "j f_m +- f_r1, j = 1..7", lambda s: sensor.lines_present(s, SIDEBANDS)),
    _part("4d", "more orders appear with clearance", sensor.orders_appear),
    _part("4e", "4..7 f_m grow with clearance", sensor.high_orders_grow),
    _part("4f", "sidebands of 4..7 f_m grow", sensor.side_bands_grow),
    _part("5a", "f_m rises from 0 to 5 um", lambda s: sensor.moves(s, "fm1", low=0.0, high=5.0, up=True)),
    _part("5b", "f_m has its maximum near 5 um", lambda s: sensor.peak_near(s, "fm1", at_um=5.0, tolerance_um=5.0)),
    _part("5c", "f_m falls from 5 to 45 um", lambda s: sensor.moves(s, "fm1", low=5.0, high=45.0, up=False)),
    _part("5d", "2f_m falls from 0 to 5 um", lambda s: sensor.moves(s, "fm2", low=0.0, high=5.0, up=False)),
    _part("5e", "2f_m rises from 5 to 45 um", lambda s: sensor.moves(s, "fm2", low=5.0, high=45.0, up=True)),
    _part("5f", "2f_m exceeds f_m", sensor.second_exceeds),
    _part("5g", "2f_m has its maximum near 45 um", lambda s: sensor.peak_near(s, "fm2", at_um=45.0, tolerance_um=5.0)),
    _part("5h", "then both fall, higher orders rise", sensor.after_top),
    _part("5i", "f_o1 irregular below 15 um", lambda s: sensor.irregular_then_growing(s)[0]),
    _part("5j", "f_o1 grows above 15 um", lambda s: sensor.irregular_then_growing(s)[1]),
    _part("5k", "f_o1 the largest of its family", sensor.fundamental_largest),
    _part("6a", "orbit widens", sensor.orbit_widens),
    _part("6b", "more in y than in x", sensor.more_in_y),
    _part("6c", "more peaks in polar form", sensor.peaks_grow),
    _part("6d", "shaft moves away from the centre, more in y", sensor.moves_away),
    _part("7a", "stiffness modulation grows with speed", lambda s: speed.with_speed(s, "k_single_at_f_o1")),
    _part("7b", "RMS rises (acceleration)", lambda s: speed.with_speed(s, "acc_rms")),
    _part("7c", "RMS about the mean rises (displacement)", lambda s: speed.with_speed(s, "y_std")),
    _part("7d", "peak-to-peak rises (acceleration)", lambda s: speed.with_speed(s, "acc_range")),
    _part("7e", "peak-to-peak rises (displacement)", lambda s: speed.with_speed(s, "y_range")),
    _part("7f", "f_m rises (acceleration)", lambda s: speed.with_speed(s, "fm1")),
    _part("7g", "f_m rises (displacement)", lambda s: speed.with_speed(s, "fm1", power=2)),
    _part("7h", "f_o1 rises (acceleration)", lambda s: speed.with_speed(s, "fo1")),
    _part("7i", "f_o1 rises (displacement)", lambda s: speed.with_speed(s, "fo1", power=2)),
    _part("7j", "2..5 f_m fall (acceleration)", lambda s: speed.multiples_fall(s, 0)),
    _part("7k", "2..5 f_m fall (displacement)", lambda s: speed.multiples_fall(s, 2)),
    _part("7l", "sidebands only around f_m and 2f_m", speed.sidebands_stay_low),
    _part("8a", "3..7 f_m", lambda s: speed.experiment_lines(s, ("fm3", "fm4", "fm5", "fm6", "fm7"))),
    _part("8b", "4, 5, 6 f_o1", lambda s: speed.experiment_lines(s, ("fo4", "fo5", "fo6"))),
    _part("8c", "1..3 f_m +- f_r1", lambda s: speed.experiment_lines(s, SIDEBANDS[:6])),
    _part("8d", "time signal modulated at f_o1", speed.shocks_at_f_o1),
)
