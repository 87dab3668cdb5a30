"""The unit table against independent values, and that nothing outside it passes."""

from __future__ import annotations

import math

import pytest

from signals.units import UNITS, find_unit, normal, unit_of, units_of
from sim.core.errors import SpecError


@pytest.mark.parametrize(
    ("text", "si", "factor"),
    [
        ("g", "m/s^2", 9.80665),
        ("m/s²", "m/s^2", 1.0),
        ("m / s**2", "m/s^2", 1.0),
        ("[m/s^2]", "m/s^2", 1.0),
        ("mm/s", "m/s", 1e-3),
        ("in/s", "m/s", 0.0254),
        ("µm", "m", 1e-6),
        ("μm", "m", 1e-6),
        ("mil", "m", 25.4e-6),
        ("in", "m", 0.0254),
        # NIST SP 811 (2008), appendix B.8: pound-force 4.448 222 N, kip 4.448 222 kN, psi 6.894 757 kPa
        ("lb", "N", 4.448222),
        ("kip", "N", 4448.222),
        ("psi", "Pa", 6894.757),
        ("lbf in", "N m", 0.1129848),
        ("lbf·ft", "N m", 1.355818),
        ("N*m", "N m", 1.0),
        ("N m", "N m", 1.0),
        ("Nm", "N m", 1.0),
        ("mV", "V", 1e-3),
        ("rpm", "Hz", 1 / 60),
        ("deg", "rad", math.pi / 180),
        ("1", "1", 1.0),
        ("full scale", "uncalibrated", 1.0),
        ("a.u.", "uncalibrated", 1.0),
    ],
)
def test_units_are_what_the_standards_say(text: str, si: str, factor: float) -> None:
    found = unit_of(text, "unit")
    assert found.si == si
    assert found.factor == pytest.approx(factor, rel=4e-7)


def test_temperatures_have_an_offset() -> None:
    fahrenheit, celsius = unit_of("degF", "unit"), unit_of("°C", "unit")
    assert 212 * fahrenheit.factor + fahrenheit.offset == pytest.approx(100 * celsius.factor + celsius.offset)


@pytest.mark.parametrize("text", ["", "not stated", "g (as usually stated)", "G", "M/S", "furlong", "?", "mm/s/g"])
def test_an_unknown_unit_is_refused_never_guessed(text: str) -> None:
    assert find_unit(text) is None
    with pytest.raises(SpecError, match="never guessed") as caught:
        unit_of(text, "channels.0.unit")
    assert caught.value.problems[0].field == "channels.0.unit"


def test_every_key_of_the_table_is_found_under_its_own_spelling() -> None:
    assert not [text for text in UNITS if normal(text) != text]


@pytest.mark.parametrize(("text", "meant"), [("G", "g"), ("Mm/s", "mm/s"), ("RPM", "rpm"), ("m/s^4", None)])
def test_another_case_of_a_unit_is_guessed_in_words_only(text: str, meant: str | None) -> None:
    with pytest.raises(SpecError) as caught:
        unit_of(text, "channels.0.unit")
    (problem,) = caught.value.problems
    assert ("did you mean" in problem.message) == (meant is not None)
    assert meant is None or f"(did you mean {meant}?)" in problem.message


def test_the_units_of_a_quantity_are_named_once_each() -> None:
    assert units_of("acceleration")[:3] == ("m/s^2", "mm/s^2", "g")
    assert len({UNITS[one].factor for one in units_of("velocity")}) == len(units_of("velocity"))
    assert units_of("no such quantity") == ()
