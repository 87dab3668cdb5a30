"""Envelope order spectrum of the band that shows a family best, with the lines that parts would make."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from reconcile.report.figures.spectrum import ONE_PLACE, OR
from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import number, numbers, text
from reconcile.report.plot import BOTTOM, TOP, Frame, span
from reconcile.report.strict import Plain

LETTER = 6.6
"""Width of a letter, pixels."""
ROWS = {"own": (TOP + 17.0,), "other": (TOP + 32.0, TOP + 46.0)}
"""Where names may stand: those of the family above, those of other parts below."""
HEADROOM = 1.3
SLOW = 0.2
"""Order below which no part of a bearing has a line: what wanders there is left out where it would flatten the rest."""
GAP = 6.0
NONE_THERE = (
    "no part's lines stand out in any band, so none are marked; this is the band in which some came nearest to it."
)


def envelope(picture: Mapping[str, Plain]) -> Markup:
    """One panel of `envelope`; nothing where the test's curve is missing."""
    curves = [(key, css, _curve(picture.get(key))) for key, css in (("baseline", "before"), ("test", "observed"))]
    drawn = [(css, x, y) for _, css, (x, y) in curves if y]
    if not any(css == "observed" for css, _, _ in drawn):
        return Markup("")
    highest = max(_highest(x, y) for _, x, y in drawn)
    frame = Frame(
        x=span(*(x for _, x, _ in drawn), pad=0.0),
        y=(0.0, HEADROOM * highest),
        x_label=f"order, cycles per turn of {text(picture.get('shaft'), 'the shaft')}",
        y_label="depth of modulation, share of mean",
        height=290.0,
    )
    low, high = (numbers(picture.get("band_hz")) or [0.0, 0.0])[:2]
    title = f"Envelope of {text(picture.get('channel'))} between {low:.0f} and {high:.0f} Hz"
    marks = _marks(frame, picture.get("lines"))
    curves_drawn = (frame.curve(*_within(frame, x, y), css) for css, x, y in drawn)
    return frame.svg(frame.axes(), *curves_drawn, marks, title=title)


def caption(picture: Mapping[str, Plain]) -> str:
    """What is drawn, in words."""
    low, high = (numbers(picture.get("band_hz")) or [0.0, 0.0])[:2]
    speed = f" at {number(picture.get('speed_hz')):.4g} Hz" if picture.get("speed_hz") is not None else ""
    where = f"{text(picture.get('channel'))}, {low:.0f} to {high:.0f} Hz, {text(picture.get('shaft'))}{speed}"
    if not marked(picture):
        return f"{where}: {NONE_THERE}"
    site, _, kind = text(picture.get("family")).partition(".")
    what = f"{kind} family of {site}"
    if kind == "turn":
        return f"{where}: the band in which what comes once a turn of {site} stands out most."
    if not site:
        what = f"comb of impacts {number(picture.get('order')):.4g} times a turn, of no part,"
    return f"{where}: the band in which the {what} stands out most."


def marked(picture: Mapping[str, Plain]) -> bool:
    """Whether lines are told: of a family, or of impacts at an order of no part."""
    return bool(picture.get("lines"))


def beside(picture: Mapping[str, Plain]) -> bool:
    """Whether sidebands of the family are among them, as ticks."""
    lines = picture.get("lines")
    return isinstance(lines, list) and any(isinstance(x, dict) and x.get("kind") not in ROWS for x in lines)


def _highest(orders: list[float], depth: list[float]) -> float:
    """Of what is not slow, and at least something."""
    known = [(o, d) for o, d in zip(orders, depth, strict=True) if math.isfinite(d)]
    return max((d for o, d in known if o >= SLOW), default=0.0) or max((d for _, d in known), default=0.0) or 1.0


def _within(frame: Frame, orders: list[float], depth: list[float]) -> tuple[list[float], list[float]]:
    """A curve that stays in the frame; what is slow and leaves it is left out."""
    top = frame.y[1]
    kept = [(o, min(d, top)) for o, d in zip(orders, depth, strict=True) if o >= SLOW or d <= top]
    return [o for o, _ in kept], [d for _, d in kept]


def _curve(found: Plain) -> tuple[list[float], list[float]]:
    """Orders and depths."""
    if not isinstance(found, dict):
        return [], []
    step, depth = number(found.get("order_step"), 0.0), numbers(found.get("depth"))
    return [i * step for i in range(len(depth))], depth


def _marks(frame: Frame, lines: Plain) -> Markup:
    """Lines of the family over the whole height with names, its sidebands as ticks on the upper edge, other parts in
    grey; names that would collide are left out."""
    items = [x for x in lines if isinstance(x, dict)] if isinstance(lines, list) else []
    parts: list[Markup] = []
    taken: dict[float, list[tuple[float, float]]] = {}
    bottom = frame.height - BOTTOM
    for item in sorted(items, key=lambda i: number(i.get("order"))):
        order, kind, label = number(item.get("order")), text(item.get("kind"), "other"), text(item.get("label"))
        if not frame.x[0] <= order <= frame.x[1]:
            continue
        at = frame.px(order)
        if kind in ROWS and (same := _at_one_place(frame, items, kind, at)):
            if label != same[0]:
                continue
            label = OR.join(same)
        if kind not in ROWS:
            parts.append(tag("line", x1=at, x2=at, y1=TOP, y2=TOP + 7.0, css="mark side"))
            continue
        row = next((y for y in ROWS[kind] if _fits(at, label, taken.setdefault(y, []), frame)), None)
        top = ROWS[kind][-1] if row is None else row
        parts.append(tag("line", x1=at, x2=at, y1=top + 4.0, y2=bottom, css=f"comb {kind}"))
        if row is not None:
            parts.append(tag("text", label, x=at, y=row, css=f"tick mid said comb-name {kind}"))
    return Markup("".join(parts))


def _at_one_place(frame: Frame, items: Sequence[Mapping[str, Plain]], kind: str, at: float) -> list[str]:
    """Names of the lines of a kind that stand at one place on the picture."""
    there = (i for i in items if text(i.get("kind"), "other") == kind)
    near = (i for i in there if abs(frame.px(number(i.get("order"))) - at) <= ONE_PLACE)
    return list(dict.fromkeys(text(i.get("label")) for i in near if text(i.get("label"))))


def _fits(at: float, label: str, taken: list[tuple[float, float]], frame: Frame) -> bool:
    """Whether there is room for a name around `at`; takes it."""
    half = 0.5 * LETTER * len(label)
    if not label or at - half < frame.left - half or any(abs(at - o) < half + room + GAP for o, room in taken):
        return False
    taken.append((at, half))
    return True
