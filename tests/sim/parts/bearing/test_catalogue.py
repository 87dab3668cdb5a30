"""Every catalogue row: source, plausible rings, and the orders its own source prints."""

from __future__ import annotations

import pytest

from sim.core.errors import UnknownName
from sim.parts.bearing.catalogue import CatalogueRow, catalogue, cylindrical, lookup, missing
from sim.parts.bearing.frequencies import defect_orders
from sim.parts.bearing.geometry import most_balls

ROWS = list(catalogue().values())
STANDARD_BALL_M = 25.4e-3 / 32
WANTED = [f"{series}{bore:02d}" for series in (62, 63) for bore in range(3, 13)]


@pytest.mark.parametrize("row", ROWS, ids=lambda r: r.designation)
def test_row_has_a_source_and_a_maker(row: CatalogueRow) -> None:
    assert len(row.source) > 40
    assert row.maker


@pytest.mark.parametrize("row", ROWS, ids=lambda r: r.designation)
def test_rings_are_plausible(row: CatalogueRow) -> None:
    geometry = row.geometry()
    assert row.balls <= most_balls(geometry.diameter_ratio)
    if row.bore_m is None or row.outside_m is None:
        return
    mean_m = (row.bore_m + row.outside_m) / 2
    assert row.pitch_diameter_m == pytest.approx(mean_m, rel=0.035)
    assert row.pitch_diameter_m - row.ball_diameter_m > row.bore_m
    assert row.pitch_diameter_m + row.ball_diameter_m < row.outside_m
    assert 0.2 < row.ball_diameter_m / (row.outside_m - row.bore_m) < 0.35


@pytest.mark.parametrize("row", [r for r in ROWS if r.published_orders], ids=lambda r: r.designation)
def test_geometry_reproduces_the_published_orders(row: CatalogueRow) -> None:
    orders = defect_orders(row.geometry())
    ours = {
        "ftf": orders.cage,
        "bpfo": orders.outer_pass,
        "bpfi": orders.inner_pass,
        "bsf": orders.ball_spin,
        "ball_defect": orders.ball_defect,
    }
    for name, printed in row.published_orders.items():
        # Three decimals printed; the cage number of one maker is rounded the other way in its last digit.
        assert ours[name] == pytest.approx(printed, abs=1.1e-3), name


@pytest.mark.parametrize("row", [r for r in ROWS if r.basis == "inferred"], ids=lambda r: r.designation)
def test_inferred_balls_are_standard_inch_sizes(row: CatalogueRow) -> None:
    """ISO 3290 balls come in 1/32 inch steps here; the pitch circle lies midway between bore and outside."""
    steps = row.ball_diameter_m / STANDARD_BALL_M
    assert steps == pytest.approx(round(steps), abs=1e-3)
    assert row.bore_m is not None
    assert row.outside_m is not None
    assert row.pitch_diameter_m == pytest.approx((row.bore_m + row.outside_m) / 2, rel=3e-3)


def test_two_sources_agree_on_the_209() -> None:
    book, maker = lookup("6209"), lookup("209K")
    assert book.balls == maker.balls
    assert book.ball_diameter_m == pytest.approx(maker.ball_diameter_m)
    assert book.pitch_diameter_m == pytest.approx(maker.pitch_diameter_m)


@pytest.mark.parametrize("size", WANTED)
def test_common_sizes_are_there_or_listed_as_missing(size: str) -> None:
    assert (size in catalogue()) != (size in missing())


@pytest.mark.parametrize(
    ("written", "found"),
    [
        ("6205-2RS", "6205"),
        ("6205-2RS JEM", "6205"),
        ("6304ZZ", "6304"),
        ("er16k", "ER-16K"),
        ("ZA2115", "ZA-2115"),
        ("SKF 6205", "6205"),
        ("fag 6205-2RS C3", "6205"),
    ],
)
def test_lookup_ignores_seals_and_spelling(written: str, found: str) -> None:
    assert lookup(written).designation == found


@pytest.mark.parametrize(
    ("written", "roller"), [("NU205", True), ("SKF NU 205 ECP", True), ("6205", False), ("NICE", False)]
)
def test_cylindrical_rollers_are_known_by_their_designation(written: str, roller: bool) -> None:
    assert cylindrical(written) is roller


def test_unknown_names_come_with_near_matches() -> None:
    with pytest.raises(UnknownName) as error:
        lookup("6213")
    assert "6212" in error.value.known
    with pytest.raises(UnknownName, match="left out") as error:
        lookup("SKF 6305-2RS")
    assert "6306" in error.value.known


def test_rollers_have_orders_but_no_ball_stiffness() -> None:
    geometry = lookup("ZA-2115").geometry()
    assert geometry.ball_diameter_m is None
    assert defect_orders(geometry).outer_pass == pytest.approx(7.092, abs=1e-3)
