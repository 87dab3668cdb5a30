"""The `bearings` of a parameter file: designations or geometries for one to four bearings, read liberally."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError
from sim.core.spec import BallGeometry
from sim.parts.bearing.catalogue import CatalogueRow, lookup

BEARINGS = 4
_ALIASES = {
    "name": ("name", "site", "position"),
    "designation": ("designation", "catalogue", "type", "model"),
    "balls": ("balls", "nb", "n_balls", "n", "z"),
    "ratio": ("ratio", "diameter_ratio", "g", "d_over_d", "db_dm"),
    "ball_m": ("ball_diameter_m", "ball_diameter", "d_b", "db", "d"),
    "pitch_m": ("pitch_diameter_m", "pitch_diameter", "d_m", "dm"),
    "ball_mm": ("ball_diameter_mm",),
    "pitch_mm": ("pitch_diameter_mm",),
    "angle_deg": ("contact_angle_deg", "contact_angle"),
}
_NAMES = {alias: name for name, aliases in _ALIASES.items() for alias in aliases}
RATIO_TOLERANCE = 2e-3
"""Relative difference of two diameter ratios that still say the same: the seed prints four digits."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One bearing: geometry, and the designation it came from if any."""

    geometry: BallGeometry
    designation: str | None = None

    @property
    def ratio(self) -> float:
        """d_b/d_m."""
        if self.geometry.diameter_ratio is not None:
            return self.geometry.diameter_ratio
        return (self.geometry.ball_diameter_m or 0.0) / (self.geometry.pitch_diameter_m or math.inf)

    @property
    def has_diameters(self) -> bool:
        """Whether Hertz contact can be computed from it."""
        return self.geometry.ball_diameter_m is not None and self.geometry.pitch_diameter_m is not None


def entries(given: object) -> tuple[Entry, ...] | None:
    """Four bearings from a list of one (all alike), two (input, output shaft) or four; None when none are given."""
    if given is None or given == []:
        return None
    items: Sequence[object]
    if isinstance(given, Mapping) and not set(map(str.lower, map(str, given))) <= set(_NAMES):
        items = _in_order(given)
    else:
        items = given if isinstance(given, list | tuple) else [given]
        names = [_named(item) for item in items]
        if all(names) and len(items) > 1 and len(set(names)) == len(names):
            items = _in_order(dict(zip(names, items, strict=True)))
    if len(items) not in (1, 2, BEARINGS):
        message = "needs one entry (all alike), two (input and output shaft) or four"
        raise SpecError(Problem(field="bearings", message=message, given=len(items), allowed="1, 2 or 4 entries"))
    found = [_entry(item, f"bearings.{i}") for i, item in enumerate(items)]
    return tuple(found[i * len(found) // BEARINGS] for i in range(BEARINGS))


ORDERS = {1: ("bearings",), 2: ("input", "output"), BEARINGS: tuple(f"bearing{i}" for i in range(1, BEARINGS + 1))}
"""Names of one, two or four entries, in the order of the machine."""


def _named(item: object) -> str:
    """The place an entry says it stands at; empty when it says none."""
    if not isinstance(item, Mapping):
        return ""
    return next((str(value) for key, value in item.items() if _NAMES.get(str(key).lower()) == "name"), "")


def _in_order(named: Mapping[object, object]) -> list[object]:
    """Entries by name in the order of the machine; names that are no places are labels, and the given order stays.

    SpecError names what is missing, doubled or unknown among places.
    """
    expected = ORDERS.get(len(named), ORDERS[BEARINGS])
    given = [str(name) for name in named]
    if not set(given) & {place for places in ORDERS.values() for place in places} and len(given) == len(set(given)):
        return list(named.values())
    if sorted(given) != sorted(expected):
        message = "names its bearings, but not each of them once"
        allowed = ", ".join(expected)
        raise SpecError(Problem(field="bearings", message=message, given=", ".join(given), allowed=allowed))
    by_name = {str(name): item for name, item in named.items()}
    return [by_name[name] for name in expected]


def _entry(item: object, field: str) -> Entry:
    if isinstance(item, str):
        return _row(lookup(item))
    if not isinstance(item, Mapping):
        allowed = "a designation, or an object with balls and ratio or diameters"
        raise SpecError(Problem(field=field, message="is no bearing", given=str(item), allowed=allowed))
    return _object({str(k): v for k, v in item.items()}, field)


def _row(row: CatalogueRow) -> Entry:
    geometry = BallGeometry(
        balls=row.balls,
        ball_diameter_m=row.ball_diameter_m,
        pitch_diameter_m=row.pitch_diameter_m,
        contact_angle_deg=math.degrees(row.contact_angle_rad),
        inner_groove_ratio=row.inner_groove_ratio,
        outer_groove_ratio=row.outer_groove_ratio,
    )
    return Entry(geometry=geometry, designation=row.designation)


def _object(item: Mapping[str, object], field: str) -> Entry:
    values: dict[str, object] = {}
    problems = []
    for key, value in item.items():
        name = _NAMES.get(key.lower())
        if name is None:
            allowed = ", ".join(a for aliases in _ALIASES.values() for a in aliases)
            problems.append(Problem(field=f"{field}.{key}", message="is not a known key", given=key, allowed=allowed))
        elif name not in ("name", "designation") and not _number(value):
            problems.append(Problem(field=f"{field}.{key}", message="must be a finite number", given=str(value)))
        else:
            values[name] = value
    if problems:
        raise SpecError(problems)
    numbers = {k: float(v) for k, v in values.items() if isinstance(v, int | float)}
    if "designation" in values and "balls" not in numbers:
        return _row(lookup(str(values["designation"])))
    return Entry(geometry=_geometry(numbers, field))


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _geometry(numbers: Mapping[str, float], field: str) -> BallGeometry:
    ball = numbers.get("ball_m", numbers["ball_mm"] * 1e-3 if "ball_mm" in numbers else None)
    pitch = numbers.get("pitch_m", numbers["pitch_mm"] * 1e-3 if "pitch_mm" in numbers else None)
    ratio = numbers.get("ratio")
    balls = numbers.get("balls")
    angle = numbers.get("angle_deg", 0.0)
    if ratio is None and ball is not None and pitch is not None:
        ratio = ball / pitch if pitch > 0 else math.nan
    checks = (
        ("balls", balls, balls is not None and 3 <= balls <= 64 and balls % 1 == 0, "a whole number from 3 to 64"),
        ("ratio", ratio, ratio is not None and 0 < ratio < 0.9, "above 0, below 0.9 (or both diameters)"),
        ("ball_diameter_m", ball, ball is None or 0 < ball <= 0.5, "above 0 to 0.5"),
        ("pitch_diameter_m", pitch, pitch is None or 0 < pitch <= 5, "above 0 to 5"),
        ("contact_angle_deg", angle, 0 <= angle <= 50, "0 to 50"),
    )
    problems = [
        Problem(field=f"{field}.{n}", message="is missing" if v is None else "is out of bounds", given=v, allowed=a)
        for n, v, good, a in checks
        if not good
    ]
    if problems:
        raise SpecError(problems)
    return BallGeometry(
        balls=int(balls or 0),
        ball_diameter_m=ball,
        pitch_diameter_m=pitch,
        diameter_ratio=None if ball is not None and pitch is not None else ratio,
        contact_angle_deg=angle,
    )


def merged(entry: Entry | None, balls: float | None, ratio: float | None, names: tuple[str, str]) -> tuple[Entry, str]:
    """One bearing from `bearings` and the parameters (balls, ratio): they must agree, or one must be absent.

    Returns the bearing and a warning (empty if none). Explicit numbers outrank a designation, as makers differ.
    """
    if entry is None:
        if balls is None or ratio is None:
            missing = [n for n, v in zip(names, (balls, ratio), strict=True) if v is None]
            message = "is missing, and `bearings` gives no geometry either"
            allowed = {names[0]: "a whole number from 3 to 64", names[1]: "above 0, below 0.9"}
            raise SpecError([Problem(field=f"parameters.{n}", message=message, allowed=allowed[n]) for n in missing])
        return Entry(geometry=BallGeometry(balls=int(balls), diameter_ratio=ratio)), ""
    same = (balls is None or balls == entry.geometry.balls) and (
        ratio is None or abs(ratio - entry.ratio) <= RATIO_TOLERANCE * entry.ratio
    )
    if same:
        return entry, ""
    said = " and ".join(f"{n} = {v:g}" for n, v in zip(names, (balls, ratio), strict=True) if v is not None)
    theirs = f"{entry.designation or 'geometry'}: {entry.geometry.balls} balls, ratio {entry.ratio:.4g}"
    text = f"{said} contradicts `bearings` ({theirs})"
    if entry.designation is None:
        raise SpecError(
            Problem(field=f"parameters.{names[1]}", message=text, allowed="numbers that agree, or only one")
        )
    kept = BallGeometry(
        balls=int(balls if balls is not None else entry.geometry.balls),
        diameter_ratio=ratio if ratio is not None else entry.ratio,
        contact_angle_deg=entry.geometry.contact_angle_deg,
    )
    return Entry(geometry=kept, designation=entry.designation), f"{text}; the numbers are used"
