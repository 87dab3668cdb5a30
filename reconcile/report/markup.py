"""Elements of a page whose text cannot become markup."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable

Child = object
VOID = frozenset({"br", "meta", "line", "rect", "circle", "path", "polyline", "polygon", "hr", "col"})
TEXT_KEYS = {"css": "class", "rule": "style"}


class Markup(str):
    """Text that is markup already; every other text is escaped when it is put into an element."""

    __slots__ = ()


def escaped(value: object) -> Markup:
    """Text as markup: escaped unless it is markup, None as nothing, sequences joined."""
    if isinstance(value, Markup):
        return value
    if value is None:
        return Markup("")
    if isinstance(value, Iterable) and not isinstance(value, str | bytes):
        return Markup("".join(escaped(item) for item in value))
    return Markup(html.escape(str(value), quote=True))


def _attribute(name: str, value: object) -> str:
    key = TEXT_KEYS.get(name, name.replace("_", "-"))
    text = f"{value:.2f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)
    return f' {key}="{html.escape(text, quote=True)}"'


def tag(name: str, /, *children: Child, **attributes: object) -> Markup:
    """An element. Attribute `css` is `class`, underscores are hyphens, None leaves the attribute out."""
    head = name + "".join(_attribute(k, v) for k, v in attributes.items() if v is not None)
    body = "".join(escaped(child) for child in children)
    return Markup(f"<{head}/>" if name in VOID and not body else f"<{head}>{body}</{name}>")


PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
PREFIXED = frozenset({"m", "N", "s", "V", "Pa", "Hz", "J", "W", "rad", "N/m", "N*m", "N s/m", "m/s", "m/s^2"})
"""Units before which a prefix reads well."""


def power_of(value: float, unit: str) -> int:
    """The power of ten of the prefix with which a value reads best in its unit."""
    size = abs(value)
    if unit not in PREFIXED or not math.isfinite(value) or size == 0 or 0.1 <= size < 1e4:
        return 0
    return min(max(3 * math.floor(math.log10(size) / 3), -9), 9)


def figure_text(value: float, unit: str = "", digits: int = 3, power: int | None = None) -> str:
    """A number for a reader: `digits` figures, plain where it can be, with its unit (`2.1e-5`, `m` -> `21 µm`), by the
    prefix of that `power` of ten where one is given."""
    if not math.isfinite(value):
        return "–"
    raised = power_of(value, unit) if power is None else power
    if raised:
        value *= 10.0**-raised
    prefix, size = PREFIXES[raised], abs(value)
    if size == 0 or 1e-3 <= size < 1e5:
        text = f"{value:.0f}" if size >= 10**digits else f"{value:.{digits}g}"
    else:
        text = f"{value:.{digits - 1}e}"
    return f"{text} {prefix}{_raised(unit)}".strip() if unit not in ("", "1") else text


def _raised(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³")
