"""Bearing catalogue: internal geometry of common sizes, every row with a source that can be cited.

A size without a source is not here; `missing()` lists it with the reason. Makers differ by a few per cent in pitch
diameter for the same designation, so each row also says whose bearing it is.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any, Literal

from sim.core.errors import UnknownName
from sim.core.near import near
from sim.parts.bearing.geometry import RollingGeometry, from_diameters

_MM = 1e-3
_SUFFIXES = re.compile(r"^(6[0-4]?\d\d\d?)(?:[-/ ]*(?:2RSR?|2RS\d?|RS|2Z|ZZ|Z|LLU|DDU|VV|NR|N|C[2-5]|JEM|TN\d?|M))+$")
"""Seals, shields, snap ring grooves, clearance classes and cages: none changes balls or pitch circle."""

_MAKERS = re.compile(r"^(?:SKF|FAG|INA|NSK|NTN|KOYO|NACHI|TIMKEN|FAFNIR|MRC|SNR|RHP|STEYR|HRB|ZWZ|LYC|EZO|NMB)[\s:/-]+")
"""Written before a designation: makers keep to the same numbers (ISO 15); a row says whose bearing it is."""
_CYLINDRICAL = re.compile(r"^(?:NU|NJ|NUP|NF|N|RNU)[\s-]*\d{3,4}")


@dataclass(frozen=True, kw_only=True)
class CatalogueRow:
    """One bearing (of a multi-row bearing: one row of it), lengths in m.

    `basis` is `published` when the source prints both diameters, `inferred` when it prints the number of balls and
    the orders, and the diameters follow from them: ball from the standard inch sizes, pitch diameter from the ring.
    `published_orders` are the orders the source prints (`ftf`, `bpfo`, `bpfi`, `bsf` or `ball_defect` = 2 BSF).
    `inner_groove_ratio` and `outer_groove_ratio` are the usual defaults unless the source states them.
    """

    designation: str
    maker: str
    element: Literal["ball", "roller"]
    balls: int
    ball_diameter_m: float
    pitch_diameter_m: float
    contact_angle_rad: float
    inner_groove_ratio: float
    outer_groove_ratio: float
    bore_m: float | None
    outside_m: float | None
    width_m: float | None
    basis: Literal["published", "inferred"]
    source: str
    published_orders: Mapping[str, float]

    def geometry(self) -> RollingGeometry:
        """Geometry for orders and stiffness; for rollers the ratio only, as point contact does not apply to them."""
        if self.element == "roller":
            return RollingGeometry(
                balls=self.balls,
                diameter_ratio=self.ball_diameter_m / self.pitch_diameter_m,
                contact_angle_rad=self.contact_angle_rad,
                width_m=self.width_m,
            )
        return from_diameters(
            balls=self.balls,
            ball_diameter_m=self.ball_diameter_m,
            pitch_diameter_m=self.pitch_diameter_m,
            contact_angle_rad=self.contact_angle_rad,
            inner_groove_ratio=self.inner_groove_ratio,
            outer_groove_ratio=self.outer_groove_ratio,
            width_m=self.width_m,
        )


def _row(raw: Mapping[str, Any], sources: Mapping[str, str]) -> CatalogueRow:
    def metres(key: str) -> float | None:
        value = raw[key]
        return None if value is None else float(value) * _MM

    return CatalogueRow(
        designation=raw["designation"],
        maker=raw["maker"],
        element=raw["element"],
        balls=raw["balls"],
        ball_diameter_m=raw["ball_diameter_mm"] * _MM,
        pitch_diameter_m=raw["pitch_diameter_mm"] * _MM,
        contact_angle_rad=math.radians(raw["contact_angle_deg"]),
        inner_groove_ratio=raw.get("inner_groove_ratio", 0.515),
        outer_groove_ratio=raw.get("outer_groove_ratio", 0.525),
        bore_m=metres("bore_mm"),
        outside_m=metres("outside_mm"),
        width_m=metres("width_mm"),
        basis=raw["basis"],
        source=sources[raw["source"]],
        published_orders=MappingProxyType(dict(raw.get("published_orders", {}))),
    )


@cache
def _file() -> Mapping[str, Any]:
    text = files("sim.parts.bearing").joinpath("catalogue.json").read_text(encoding="utf-8")
    content: Mapping[str, Any] = json.loads(text)
    return content


@cache
def catalogue() -> Mapping[str, CatalogueRow]:
    """All rows by designation."""
    content = _file()
    rows = [_row(raw, content["sources"]) for raw in content["bearings"]]
    return MappingProxyType({row.designation: row for row in rows})


def missing() -> Mapping[str, str]:
    """Sizes that were looked for and left out, with the reason."""
    return MappingProxyType(dict(_file()["missing"]))


def bare(designation: str) -> str:
    """Without the maker before it and suffixes that change neither balls nor pitch circle."""
    plain = _MAKERS.sub("", designation.strip().upper())
    base = _SUFFIXES.match(plain)
    return base.group(1) if base else plain


def cylindrical(designation: str) -> bool:
    """Whether a designation is one of a cylindrical roller bearing (ISO 15: N, NU, NJ), of which there are none."""
    return _CYLINDRICAL.match(bare(designation)) is not None


def _folded(designation: str) -> str:
    return re.sub(r"[^A-Z0-9]", "", designation.upper())


@cache
def _by_folded() -> Mapping[str, CatalogueRow]:
    return MappingProxyType({_folded(name): row for name, row in catalogue().items()})


def lookup(designation: str) -> CatalogueRow:
    """Row of a designation; the maker before it and seal, shield, clearance and cage suffixes are ignored. UnknownName
    with near matches."""
    by_folded = _by_folded()
    wanted = bare(designation)
    for name in (designation, wanted):
        if _folded(name) in by_folded:
            return by_folded[_folded(name)]
    reason = missing().get(wanted)
    kind = "bearing" if reason is None else f"bearing (left out: {reason}; its geometry can be given instead)"
    known = [by_folded[n].designation for n in near(_folded(wanted), by_folded, most=5)] or list(catalogue())
    raise UnknownName(kind, designation, known)
