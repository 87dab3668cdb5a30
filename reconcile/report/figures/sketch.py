"""A sketch of the machine from its specification: shafts as bars, gears, bearings, bodies; located places stand out.

It shows who is joined to whom, not the drawing: parts sit along their shaft in the order of the seats where those are
given, else in the order of the specification.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import number, text
from reconcile.report.strict import Plain
from reconcile.report.words import weight as share_of

WIDTH, LANE, MARGIN = 720.0, 116.0, 70.0
SLIM, FEW = 360.0, 2
"""Width of a sketch of so many parts a lane: it fits a phone."""
NARROW_PART, NARROW_MARGIN = 82.0, 12.0
"""Room of a part, and beside all, where the screen is narrow: a longer shaft is drawn smaller there."""
RING = 36.0
"""Around what is located: clear of its name below."""
GROUND = ""
"""Lane of parts on no shaft."""


@dataclass(kw_only=True)
class _Lane:
    name: str
    seats: Mapping[str, Plain]
    parts: list[tuple[str, str]] = field(default_factory=list)
    """(kind, name)."""


def _items(machine: Mapping[str, Plain], key: str) -> list[dict[str, Plain]]:
    found = machine.get(key)
    return [item for item in found if isinstance(item, dict)] if isinstance(found, list) else []


def _lanes(machine: Mapping[str, Plain]) -> list[_Lane]:
    lanes = {}
    for shaft in _items(machine, "shafts"):
        seats = shaft.get("seats")
        lanes[text(shaft.get("name"))] = _Lane(
            name=text(shaft.get("name")), seats=seats if isinstance(seats, dict) else {}
        )
    home = {}
    for kind, key in (("gear", "gears"), ("body", "bodies")):
        for part in _items(machine, key):
            name, shaft_name = text(part.get("name")), text(part.get("shaft"))
            lanes.setdefault(shaft_name, _Lane(name=shaft_name, seats={})).parts.append((kind, name))
            home[name] = shaft_name
    for i, bearing in enumerate(_items(machine, "bearings")):
        lane = lanes.setdefault(home.get(text(bearing.get("body")), GROUND), _Lane(name=GROUND, seats={}))
        place = 0 if i % 2 == 0 else len(lane.parts)
        lane.parts.insert(place, ("bearing", text(bearing.get("name"))))
    for lane in lanes.values():
        if all(name in lane.seats for _, name in lane.parts):
            lane.parts.sort(key=lambda part: number(lane.seats[part[1]]))
    return list(lanes.values())


def _body(kind: str, x: float, y: float) -> list[Markup]:
    if kind == "gear":
        return [tag("rect", x=x - 11, y=y - 32, width=22, height=64, rx=3, css="part gear")]
    if kind == "bearing":
        boxes = [
            tag("rect", x=x - 13, y=y + s * 18 - 10, width=26, height=20, rx=3, css="part bearing") for s in (-1, 1)
        ]
        return boxes + [tag("circle", cx=x, cy=y + s * 18, r=6, css="part ball") for s in (-1, 1)]
    return [tag("rect", x=x - 17, y=y - 24, width=34, height=48, rx=4, css="part body")]


def _spring(x: float, y: float) -> Markup:
    zigzag = " ".join(f"{x + dx:.1f},{y + 24 + dy:.1f}" for dx, dy in ((0, 0), (5, 4), (-5, 8), (5, 12), (0, 16)))
    return Markup(
        tag("polyline", points=zigzag, css="spring")
        + tag("line", x1=x - 14, x2=x + 14, y1=y + 40, y2=y + 40, css="shaft")
    )


def _place(name: str, x: float, y: float, weights: Mapping[str, float], at: float = 50.0) -> list[Markup]:
    """Ring around a located part with its share of the evidence, and the part's name."""
    weight = weights.get(name, 0.0)
    label = tag("text", name, x=x, y=y + at, css="part-name mid")
    if weight <= 0.0:
        return [label]
    ring = tag("circle", cx=x, cy=y, r=RING, css="located", rule=f"opacity:{0.25 + 0.75 * min(weight, 1):.2f}")
    return [ring, label, tag("text", _share(weight), x=x + 34, y=y - 30, css="located-share")]


def _share(weight: float) -> str:
    """As in the list beside it, in less room: nearly all is not all."""
    return share_of(weight).replace("more than ", "> ")


def sketch(machine: Mapping[str, Plain], weights: Mapping[str, float]) -> Markup:
    """The machine with the located places; nothing where the specification has no parts."""
    lanes = _lanes(machine)
    if not any(lane.parts for lane in lanes):
        return Markup("")
    most = max(len(lane.parts) for lane in lanes)
    if most <= FEW:
        return _drawn(machine, lanes, weights, SLIM, "plot sketch slim")
    narrow = min(max(SLIM, NARROW_PART * most), WIDTH)
    return Markup(
        _drawn(machine, lanes, weights, WIDTH, "plot sketch wide")
        + _drawn(machine, lanes, weights, narrow, "plot sketch narrow", margin=NARROW_MARGIN)
    )


def _drawn(
    machine: Mapping[str, Plain],
    lanes: Sequence[_Lane],
    weights: Mapping[str, float],
    width: float,
    css: str,
    margin: float = MARGIN,
) -> Markup:
    """One size of it; where there is little room the names of shafts stand above their parts."""
    parts: list[Markup] = []
    places: dict[str, tuple[float, float]] = {}
    for row, lane in enumerate(lanes):
        y = LANE * (row + 0.5)
        step = (width - 2 * margin) / max(len(lane.parts), 1)
        if lane.name:
            parts.append(tag("line", x1=24, x2=width - 24, y1=y, y2=y, css="shaft"))
            parts.append(tag("text", lane.name, x=26, y=y - (8 if margin == MARGIN else 40), css="shaft-name"))
            places[lane.name] = (40.0, y)
        for i, (kind, name) in enumerate(lane.parts):
            x = margin + step * (i + 0.5)
            places[name] = (x, y)
            parts += _body(kind, x, y) + ([] if lane.name else [_spring(x, y)])
            parts += _place(name, x, y, weights, -38.0 if kind == "gear" else 54.0 if not lane.name else 50.0)
    parts += _meshes(machine, places, weights)
    box = f"0 0 {width:g} {LANE * len(lanes):g}"
    return tag("svg", tag("title", "Machine and located place"), *parts, viewBox=box, role="img", css=css)


def _meshes(
    machine: Mapping[str, Plain], places: Mapping[str, tuple[float, float]], weights: Mapping[str, float]
) -> list[Markup]:
    parts = []
    for mesh in _items(machine, "meshes"):
        ends = [places.get(text(mesh.get(key))) for key in ("pinion", "gear")]
        name = text(mesh.get("name"))
        if ends[0] is None or ends[1] is None:
            continue
        (xa, ya), (xb, yb) = ends[0], ends[1]
        css = "mesh located-mesh" if weights.get(name, 0.0) > 0 else "mesh"
        parts.append(tag("line", x1=xa, y1=ya + 32, x2=xb, y2=yb - 32, css=css))
        share = f" {_share(weights[name])}" if weights.get(name, 0.0) > 0 else ""
        parts.append(tag("text", name + share, x=0.5 * (xa + xb) + 10, y=0.5 * (ya + yb) - 6, css="part-name"))
    return parts
