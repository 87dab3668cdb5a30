"""The lines printed at the end of a simulation: of which channel, how sure, how long it took."""

from __future__ import annotations

from typing import Any

from app.cli.lines import STRONGEST, listed, spent


def peak(label: str, amplitude: float, status: str = "present", **more: object) -> dict[str, Any]:
    return {"label": label, "frequency_hz": 690.0, "amplitude": amplitude, "unit": "m/s^2", "status": status, **more}


def test_the_channel_and_the_number_of_lines_are_told() -> None:
    peaks = [peak(f"{k}*f_m", float(k)) for k in range(1, 21)] + [peak("1*f_c1", 99.0, "absent")]
    head, *lines = listed({"channel": "resonator1.y.acceleration", "peaks": peaks})
    assert head.startswith("resonator1.y.acceleration: the 12 strongest of 20 labelled lines (")
    assert len(lines) == STRONGEST and lines[0].split()[0] == "20*f_m" and "f_c1" not in "".join(lines)
    assert listed({"channel": "a", "peaks": peaks[:3]})[0].startswith("a: 3 labelled lines (")
    assert listed({"channel": None, "peaks": []}) == []


def test_an_ambiguous_line_says_so_and_what_else_it_may_be() -> None:
    doubt = peak("3*f_o1", 2.0, "ambiguous", alternatives=["1*f_m-2*f_c1", "a", "b", "c", "d"])
    head, first, second, third = listed(
        {"channel": "x", "peaks": [doubt, peak("1*f_m", 3.0), peak("q", 1.0, "ambiguous")]}
    )
    assert "3 labelled lines, 2 of them ambiguous" in head
    assert "ambiguous" not in first
    assert second.endswith("ambiguous: or 1*f_m-2*f_c1, a, b and 2 more")
    assert third.endswith("m/s^2   ambiguous")


def test_unexplained_lines_are_counted_and_the_stronger_ones_told() -> None:
    peaks = [peak(f"{k}*f_m", float(k)) for k in range(1, 21)]
    strange = [peak("", a, "unexplained") for a in (30.0, 25.0, 3.0)]
    about = {"channel": "x", "found": 43, "unexplained": 23}
    second = listed({**about, "peaks": [*peaks, *strange]})[1]
    assert second.startswith("23 of 43 found lines are unexplained: 2 of them stronger than the last one listed")
    assert second.endswith("the strongest 30 m/s^2 at 690.00 Hz")
    assert "2 or more of them stronger" in listed({**about, "peaks": [*peaks, *strange[:2]]})[1]
    assert "none stronger than those listed" in listed({**about, "peaks": [*peaks, *strange[2:]]})[1]
    assert listed({**about, "peaks": strange})[0].startswith("23 of 43 found lines are unexplained: no line has a name")


def test_a_cause_without_which_the_line_grows_says_so() -> None:
    causes = [
        {"term": "transmission_error", "site": "mesh1", "share": 0.92, "removed_db": -2.89},
        {"term": "ball_contact", "site": "bearing1", "share": 0.08, "removed_db": 0.5},
    ]
    _, rule, line = listed(
        {"channel": "x", "cause_rule": "shapley_power", "peaks": [peak("3*f_m", 1.0, causes=causes)]}
    )
    assert "by Shapley's value" in rule
    assert line.endswith("92 % transmission_error@mesh1 (without it the line grows by 2.9 dB)")


def test_time_is_told_as_motion_and_computing() -> None:
    assert spent(2.0, 1, 0.4321) == "2 s of motion, computed in 0.432 s"
    assert spent(0.5, 8, 12.3) == "0.5 s of motion in each of 8 runs, computed in 12.3 s"
