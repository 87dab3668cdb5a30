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


def test_time_is_told_as_motion_and_computing() -> None:
    assert spent(2.0, 1, 0.4321) == "2 s of motion, computed in 0.432 s"
    assert spent(0.5, 8, 12.3) == "0.5 s of motion in each of 8 runs, computed in 12.3 s"
