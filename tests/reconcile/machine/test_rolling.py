"""Which part an effect strikes, and how often."""

from __future__ import annotations

import pytest

from reconcile.machine.rolling import family_of, kind_of, known_family, rate_of
from sim.parts.bearing.from_spec import geometry_from_spec
from sim.presets import preset


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("outer_spall@bearing1", "outer"),
        ("ball_spall@bearing1", "ball"),
        ("tooth_crack@gear", "tooth"),
        ("unbalance@gear", ""),
        ("nothing@gear", ""),
    ],
)
def test_what_effects_strike(name: str, kind: str) -> None:
    assert kind_of(name) == kind


def test_the_rate_of_balls_over_a_pit_is_the_textbooks() -> None:
    machine = preset("paper")
    bearing = next(b for b in machine.bearings if b.name == "bearing1")
    geometry = geometry_from_spec(bearing, field="bearings")
    ratio, balls = geometry.diameter_ratio, geometry.balls
    outer, inner = (rate_of(family_of(machine, f"{kind}_spall@bearing1"), 30.0) for kind in ("outer", "inner"))
    assert outer.hz == pytest.approx(0.5 * balls * 30.0 * (1 - ratio), rel=1e-6) and outer.sidebands == 0
    assert inner.hz == pytest.approx(0.5 * balls * 30.0 * (1 + ratio), rel=1e-6)
    assert inner.spacing_hz == pytest.approx(30.0) and inner.sidebands > 0, "a pit that turns with the shaft"


def test_a_part_of_no_known_lines_has_no_family() -> None:
    machine = preset("paper")
    assert known_family(machine, "outer_spall@bearing1") == family_of(machine, "outer_spall@bearing1")
    assert known_family(machine, "outer_spall@bearing9") is None
