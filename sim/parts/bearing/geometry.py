"""Rolling-element geometry of a ball bearing, checked when it is made."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError

CAGE_MARGIN = 0.01
"""Least gap between neighbouring balls over the ball diameter: room for the thinnest cage web."""
RATIO_LOW, RATIO_HIGH = 0.01, 0.6
"""Bounds of d_b/d_m: below, the ring is a thin-section bearing of hundreds of balls; above, no inner ring is left."""
GROOVE_LOW, GROOVE_HIGH = 0.5, 0.6
"""Groove radius over ball diameter: at 0.5 the groove is as tight as the ball and the contact is no point contact."""
RATIO_TOLERANCE = 1e-3
"""Relative disagreement allowed between a given ratio and the ratio of given diameters."""
BALL_DIAMETER_HIGH_M = 0.5


def most_balls(diameter_ratio: float) -> int:
    """Largest number of balls that fits the pitch circle with a cage: chord d_m sin(pi/z) >= (1 + margin) d_b."""
    return math.floor(math.pi / math.asin(min(1.0, (1 + CAGE_MARGIN) * diameter_ratio)) + 1e-9)


@dataclass(frozen=True, kw_only=True)
class RollingGeometry:
    """One row of balls between two grooved rings, SI units.

    `diameter_ratio` is d_b/d_m. Both diameters are None when only the ratio is known: orders can then be computed,
    contact stiffness can't. `inner_groove_ratio` and `outer_groove_ratio` are groove radius over ball diameter
    (f_i, f_o of Harris & Kotzalas, Rolling Bearing Analysis, 5th ed., 2006, chapter 2).
    """

    balls: int
    diameter_ratio: float
    ball_diameter_m: float | None = None
    pitch_diameter_m: float | None = None
    contact_angle_rad: float = 0.0
    inner_groove_ratio: float = 0.515
    outer_groove_ratio: float = 0.525
    width_m: float | None = None

    def __post_init__(self) -> None:
        problems = _scalar_problems(self) or _fit_problems(self)
        if problems:
            raise SpecError(problems)

    @property
    def gamma(self) -> float:
        """d_b cos(alpha) / d_m, the number all kinematics and curvatures depend on."""
        return self.diameter_ratio * math.cos(self.contact_angle_rad)

    def diameters_m(self) -> tuple[float, float]:
        """Ball and pitch diameter, m; SpecError when only their ratio is known."""
        if self.ball_diameter_m is None or self.pitch_diameter_m is None:
            message = "is needed for the ball-race stiffness; only the diameter ratio is known"
            raise SpecError(Problem(field="ball_diameter_m", message=message, allowed="a diameter", unit="m"))
        return self.ball_diameter_m, self.pitch_diameter_m


def from_diameters(
    *,
    balls: int,
    ball_diameter_m: float,
    pitch_diameter_m: float,
    contact_angle_rad: float = 0.0,
    inner_groove_ratio: float = 0.515,
    outer_groove_ratio: float = 0.525,
    width_m: float | None = None,
) -> RollingGeometry:
    """Geometry from both diameters, m."""
    named = (("ball_diameter_m", ball_diameter_m), ("pitch_diameter_m", pitch_diameter_m))
    problems = [_length_problem(name, value) for name, value in named]
    if any(problems):
        raise SpecError([p for p in problems if p])
    return RollingGeometry(
        balls=balls,
        diameter_ratio=ball_diameter_m / pitch_diameter_m,
        ball_diameter_m=ball_diameter_m,
        pitch_diameter_m=pitch_diameter_m,
        contact_angle_rad=contact_angle_rad,
        inner_groove_ratio=inner_groove_ratio,
        outer_groove_ratio=outer_groove_ratio,
        width_m=width_m,
    )


def _length_problem(field: str, value: float) -> Problem | None:
    if math.isfinite(value) and 0 < value <= 10:
        return None
    return Problem(field=field, message="must be a positive length", given=value, allowed="above 0, up to 10", unit="m")


def _range_problem(field: str, value: float, low: float, high: float, unit: str = "") -> Problem | None:
    """Problem unless low < value <= high (NaN fails)."""
    if low < value <= high:
        return None
    message = "is out of bounds"
    return Problem(field=field, message=message, given=value, allowed=f"above {low:g}, up to {high:g}", unit=unit)


def _scalar_problems(g: RollingGeometry) -> list[Problem]:
    """Each number by itself."""
    found = [
        _range_problem("balls", g.balls, 2, 400),
        _range_problem("diameter_ratio", g.diameter_ratio, RATIO_LOW, RATIO_HIGH),
        _range_problem("inner_groove_ratio", g.inner_groove_ratio, GROOVE_LOW, GROOVE_HIGH),
        _range_problem("outer_groove_ratio", g.outer_groove_ratio, GROOVE_LOW, GROOVE_HIGH),
        _range_problem("contact_angle_rad", g.contact_angle_rad, -1e-12, math.radians(60), "rad"),
    ]
    for field in ("ball_diameter_m", "pitch_diameter_m", "width_m"):
        value = getattr(g, field)
        if value is not None:
            found.append(_length_problem(field, value))
    if g.ball_diameter_m is not None and BALL_DIAMETER_HIGH_M < g.ball_diameter_m < 1000 * BALL_DIAMETER_HIGH_M:
        message = "is larger than any ball (it would fit if meant in mm; lengths are given in m)"
        allowed = f"up to {BALL_DIAMETER_HIGH_M:g}"
        found.append(
            Problem(field="ball_diameter_m", message=message, given=g.ball_diameter_m, allowed=allowed, unit="m")
        )
    return [p for p in found if p is not None]


def _fit_problems(g: RollingGeometry) -> list[Problem]:
    """The numbers with each other."""
    found: list[Problem] = []
    if (g.ball_diameter_m is None) != (g.pitch_diameter_m is None):
        missing = "ball_diameter_m" if g.ball_diameter_m is None else "pitch_diameter_m"
        message = "is missing: give both diameters or neither"
        found.append(Problem(field=missing, message=message, allowed="a diameter", unit="m"))
    elif g.ball_diameter_m is not None and g.pitch_diameter_m is not None:
        ratio = g.ball_diameter_m / g.pitch_diameter_m
        if abs(ratio - g.diameter_ratio) > RATIO_TOLERANCE * ratio:
            message = "disagrees with the two diameters"
            given, allowed = g.diameter_ratio, f"{ratio:.6g} (or leave it out)"
            found.append(Problem(field="diameter_ratio", message=message, given=given, allowed=allowed))
    most = most_balls(g.diameter_ratio)
    if g.balls > most:
        message = f"do not fit on the pitch circle at d_b/d_m = {g.diameter_ratio:.4g}"
        found.append(Problem(field="balls", message=message, given=g.balls, allowed=f"3 to {most}"))
    if g.width_m is not None and g.ball_diameter_m is not None and g.ball_diameter_m >= g.width_m:
        message = "is narrower than the balls"
        allowed = f"above {g.ball_diameter_m:g}"
        found.append(Problem(field="width_m", message=message, given=g.width_m, allowed=allowed, unit="m"))
    return found
