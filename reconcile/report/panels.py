"""Panels by operating point: all speeds and loads are there, the first is open, a page stays of a size to send."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from reconcile.report.figures.maps import MOST_CELLS, heat, varying
from reconcile.report.figures.spectrum import spectrum
from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import number, numbers, text
from reconcile.report.strict import Plain
from reconcile.verdict import AngleWindow, LineChange, operating_point

MOST_PANELS = 320
"""Spectra of a page: some 3 kB each."""
ALL_CELLS = 40_000
"""Cells of all maps of a page: some 22 B each."""
FLAT = "Sensors in which nothing stands out over the turn, left out: {}."
Picture = Mapping[str, Plain]


def _point(picture: Picture) -> str:
    speed = number(picture.get("speed_hz"))
    return operating_point(speed, number(picture.get("torque_ratio"), 1.0)) if math.isfinite(speed) else ""


def by_point(pictures: Sequence[Picture], panels: Callable[[Sequence[Picture]], Markup]) -> Markup:
    """What `panels` makes of each operating point, to unfold where there are several."""
    groups: dict[str, list[Picture]] = {}
    for picture in pictures:
        groups.setdefault(_point(picture), []).append(picture)
    if len(groups) < 2:
        return Markup("".join(panels(group) for group in groups.values()))
    parts = []
    for i, (point, group) in enumerate(groups.items()):
        head = tag("summary", f"Operating point {point}" if point else "No operating point stated")
        parts.append(tag("details", head, panels(group), css="point", open="" if i == 0 else None))
    return Markup("".join(parts))


def spectra(pictures: Sequence[Picture], lines: Sequence[LineChange]) -> Markup:
    """Spectra of every operating point; of many channels those that changed most."""
    points = len({_point(p) for p in pictures})
    most = max(1, MOST_PANELS // max(points, 1))

    def panels(group: Sequence[Picture]) -> Markup:
        order = sorted(range(len(group)), key=lambda i: -_change(group[i]))[:most]
        drawn = [tag("h3", _title(group[i])) + spectrum(group[i], lines) for i in sorted(order)]
        more = len(group) - len(drawn)
        said = f"{more} channels that changed less are left out here; report.json has them."
        return Markup("".join(drawn) + (tag("p", said, css="muted") if more else ""))

    return by_point(pictures, panels)


def _title(picture: Picture) -> str:
    return ", ".join(part for part in (text(picture.get("channel")), _point(picture)) if part)


def _change(picture: Picture) -> float:
    """Largest difference between what was observed and what is without the answer, dB."""
    pairs = zip(numbers(picture.get("observed_db")), numbers(picture.get("before_db")), strict=False)
    return max((abs(a - b) for a, b in pairs if math.isfinite(a - b)), default=0.0)


def turns(pictures: Sequence[Picture], window: AngleWindow | None) -> Markup:
    """Maps over a shaft's turn of every operating point."""
    most = min(MOST_CELLS, ALL_CELLS // max(len(pictures), 1))
    lively = [picture for picture in pictures if varying(picture)[0].get("value")]

    def panels(group: Sequence[Picture]) -> Markup:
        drawn = []
        for picture in group:
            point = f" at {_point(picture)}" if _point(picture) else ""
            head = tag("h3", f"Shaft {text(picture.get('shaft'))}{point}")
            kept, flat = varying(picture)
            drawn.append(head + heat(kept, window, most) + (tag("p", FLAT.format(flat), css="muted") if flat else ""))
        return Markup("".join(drawn))

    return by_point(lively, panels)
