"""A plotting frame in SVG: scales, axes with round ticks, curves, bands. Coordinates are in user units (pixels)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reconcile.report.markup import PREFIXED, PREFIXES, Markup, figure_text, tag

LEFT, RIGHT, TOP, BOTTOM = 62.0, 14.0, 12.0, 40.0
MOST_POINTS = 1600
"""Points of a curve: two a pixel; longer ones keep the extremes of each stretch."""


def span(*series: Sequence[float], pad: float = 0.05) -> tuple[float, float]:
    """Smallest and largest finite value with a margin; (0, 1) when there is none."""
    values = [v for s in series for v in s if math.isfinite(v)]
    if not values:
        return 0.0, 1.0
    low, high = min(values), max(values)
    room = pad * (high - low) if high > low else 0.5 * max(abs(high), 1e-12)
    return low - room, high + room


def ticks(low: float, high: float, about: int = 6) -> list[float]:
    """Round values 1, 2, 5 times a power of ten."""
    rough = (high - low) / max(about, 1)
    if not (math.isfinite(rough) and rough > 0):
        return [low]
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= rough * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def decades(low: float, high: float) -> list[float]:
    """Values 1, 2, 5 times a power of ten, for a logarithmic axis."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [v for p in powers for m in (1.0, 2.0, 5.0) if low <= (v := m * 10.0**p) <= high]


def powers_of_ten(low: float, high: float) -> list[float]:
    """Those within the limits, for a logarithmic axis over many of them, not more than ten; 1, 2 and 5 times them over
    few."""
    found = [v for v in decades(low, high) if f"{v:.0e}"[0] == "1"]
    return found[:: math.ceil(len(found) / 10)] if len(found) > 2 else decades(low, high)


def scaled(low: float, high: float, label: str) -> tuple[float, str]:
    """Factor for tick figures and the label that says so where figures would be tiny or huge: a prefix of the unit that
    the label ends with (`displacement, m` -> `displacement, mm`), else a power of 1000."""
    most = max(abs(low), abs(high))
    if most == 0 or 0.05 <= most < 1e5:
        return 1.0, label
    power = 3 * math.floor(math.log10(most) / 3)
    before, comma, unit = label.rpartition(", ")
    if unit in PREFIXED and power in PREFIXES:
        return 10.0**-power, f"{before}{comma}{PREFIXES[power]}{unit}"
    raised = "".join("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".index(c)] for c in str(power))
    return 10.0**-power, f"{label} × 10{raised}"


def thinned(x: Sequence[float], y: Sequence[float]) -> tuple[list[float], list[float]]:
    """Fewer points with the same look: first, lowest and highest of each stretch."""
    count = min(len(x), len(y))
    if count <= MOST_POINTS:
        return list(x[:count]), list(y[:count])
    stretch = -(-2 * count // MOST_POINTS)
    kept: list[int] = []
    for start in range(0, count, stretch):
        place = range(start, min(start + stretch, count))
        finite = [i for i in place if math.isfinite(y[i])] or [start]
        kept += sorted({min(finite, key=lambda i: y[i]), max(finite, key=lambda i: y[i])})
    return [x[i] for i in kept], [y[i] for i in kept]


SLIM, BROAD = "iljtfrI.,:;|()[]'! ", "mwMWGOQ@%+−=<>√"


def text_width(text: str, *, size: float = 12.0, bold: bool = False) -> float:
    """Pixels that a text takes in the widest of the page's fonts (DejaVu Sans), about."""
    letters = sum(0.4 if c in SLIM else 0.9 if c in BROAD else 0.63 for c in text)
    return letters * size * (1.13 if bold else 1.0)


def fitting(text: str, room: float, *, bold: bool = False) -> str:
    """The text, or its beginning and an ellipsis where it takes more than `room` pixels."""
    shown = text
    while len(shown) > 1 and text_width(shown, bold=bold) > room:
        shown = f"{shown.removesuffix('…')[:-1].rstrip()}…"
    return shown


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Axes of a panel: limits in data units, size in pixels, labels with units."""

    x: tuple[float, float]
    y: tuple[float, float]
    x_label: str
    y_label: str
    width: float = 720.0
    height: float = 250.0
    left: float = LEFT
    x_ticks: Sequence[float] = ()
    """Where figures stand, instead of round values."""
    log: bool = False
    """Whether the horizontal axis is logarithmic; its limits are positive then."""
    log_y: bool = False
    """The same of the vertical axis."""

    def px(self, value: float) -> float:
        """Horizontal place of a value, kept within the panel."""
        low, high = self.x
        if self.log:
            low, high, value = math.log10(low), math.log10(high), math.log10(max(value, self.x[0]))
        share = (value - low) / ((high - low) or 1.0)
        return self.left + (self.width - self.left - RIGHT) * min(max(share, 0.0), 1.0)

    def py(self, value: float) -> float:
        """Vertical place of a value, kept within the panel."""
        low, high = self.y
        if self.log_y:
            low, high, value = math.log10(low), math.log10(high), math.log10(max(value, self.y[0]))
        share = (value - low) / ((high - low) or 1.0)
        return self.height - BOTTOM - (self.height - TOP - BOTTOM) * min(max(share, 0.0), 1.0)

    def axes(self, *, y_ticks: bool = True) -> Markup:
        """Grid, ticks and labels."""
        parts = []
        bottom = self.height - BOTTOM
        factor, x_label = scaled(*self.x, self.x_label)
        for value in self.x_ticks or (decades(*self.x) if self.log else ticks(*self.x, about=8)):
            at = self.px(value)
            parts.append(tag("line", x1=at, x2=at, y1=TOP, y2=bottom, css="grid"))
            parts.append(tag("text", figure_text(value * factor), x=at, y=bottom + 15, css="tick mid"))
        factor, y_label = (1.0, self.y_label) if self.log_y else scaled(*self.y, self.y_label)
        digits = 1 if self.log_y else 3
        heights = powers_of_ten(*self.y) if self.log_y else ticks(*self.y)
        for value in heights if y_ticks else []:
            at = self.py(value)
            parts.append(tag("line", x1=self.left, x2=self.width - RIGHT, y1=at, y2=at, css="grid"))
            parts.append(
                tag("text", figure_text(value * factor, digits=digits), x=self.left - 6, y=at + 3.5, css="tick end")
            )
        middle = 0.5 * (self.left + self.width - RIGHT)
        parts.append(tag("text", x_label, x=middle, y=self.height - 6, css="label mid"))
        if self.y_label:
            at = 0.5 * (TOP + bottom)
            turn = f"rotate(-90 13 {at:.1f})"
            parts.append(tag("text", y_label, x=13, y=at, transform=turn, css="label mid"))
        return Markup("".join(parts))

    def curve(self, x: Sequence[float], y: Sequence[float], css: str) -> Markup:
        """A line; gaps where a value is no number."""
        commands, pen = [], "M"
        for a, b in zip(*thinned(x, y), strict=True):
            if math.isfinite(a) and math.isfinite(b):
                commands.append(f"{pen}{self.px(a):.1f} {self.py(b):.1f}")
                pen = "L"
            else:
                pen = "M"
        return tag("path", d="".join(commands), css=f"curve {css}") if commands else Markup("")

    def band(self, x: Sequence[float], low: Sequence[float], high: Sequence[float], css: str) -> Markup:
        """The area between two curves, in pieces where a bound is missing."""
        parts, piece = [], list[tuple[float, float, float]]()
        for a, b, c in [*zip(x, low, high, strict=False), (math.nan, math.nan, math.nan)]:
            if math.isfinite(a) and math.isfinite(b) and math.isfinite(c):
                piece.append((a, b, c))
                continue
            if len(piece) > 1:
                there = [f"{self.px(p):.1f},{self.py(q):.1f}" for p, q, _ in piece]
                back = [f"{self.px(p):.1f},{self.py(r):.1f}" for p, _, r in reversed(piece)]
                parts.append(tag("polygon", points=" ".join(there + back), css=f"band {css}"))
            piece = []
        return Markup("".join(parts))

    def svg(self, *parts: Markup, title: str, css: str = "plot") -> Markup:
        """The panel with its parts; `title` is read out where it cannot be seen."""
        box = f"0 0 {self.width:g} {self.height:g}"
        drawn = tag("svg", tag("title", title), *parts, viewBox=box, role="img", css=css)
        return tag("div", tag("div", drawn, css="sideways"), css="figure") if css == "plot" else drawn
