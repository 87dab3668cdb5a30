"""Turning pydantic's findings into field problems: which field, what was given, what is allowed, in which unit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from signals.known_fields import expected_at, fields_beside
from signals.wording import WORDS, demanded
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean

UNITS = (
    ("_ns_per_m", "N s/m"),
    ("_n_per_m15", "N/m^1.5"),
    ("_n_per_m", "N/m"),
    ("_nms_per_rad", "N m s/rad"),
    ("_nm_per_rad", "N m/rad"),
    ("_kg_per_m3", "kg/m^3"),
    ("_kg_m2", "kg m^2"),
    ("_m_per_s2", "m/s^2"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_pa", "Pa"),
    ("_deg", "deg"),
    ("_rad", "rad"),
    ("_nm", "N m"),
    ("_n", "N"),
    ("_m", "m"),
    ("_s", "s"),
    ("_v", "V"),
    ("_ppm", "ppm"),
)
"""Unit by the ending of a field's name, longest first."""

_BOUNDS = (("gt", "> {}"), ("ge", ">= {}"), ("lt", "< {}"), ("le", "<= {}"))
_MAX_GIVEN_CHARS = 200
TAGS = {"union_tag_not_found": "is required: it says which kind this is", "union_tag_invalid": "is not a known kind"}
"""Of parts that come in several kinds."""
KINDS = (
    *("ramp", "fluctuating", "measured", "torque", "force", "modes", "impulse_response"),
    *("accelerometer", "velocity", "proximity", "tacho"),
)
WORDED = {
    r"^[a-z][a-z0-9_]{0,39}$": "a lower-case letter, then lower-case letters, digits and _, 40 characters at most",
    r"^[A-Za-z0-9_-]+$": "letters, digits, _ and -",
    r"^[A-Za-z0-9][A-Za-z0-9._-]*$": "a letter or digit, then letters, digits, dot, _ and -",
}
"""Patterns of names in words."""
FORMS: Mapping[str, tuple[str, ...]] = {"Sensitivity": ("sensitivity",), "float": ("sensitivity",)}
"""What validation calls the forms of a field that may be an object or a number, and which field that is."""
OF_KINDS = ("profile", "path")
"""Parts of several kinds beside those that stand in lists."""


def unit_of(field: str) -> str:
    """The unit that a field's name states, or an empty string."""
    name = field.rsplit(".", 1)[-1]
    return next((unit for ending, unit in UNITS if name.endswith(ending)), "")


def problems_of(error: ValidationError, prefix: str = "", model: type[BaseModel] | None = None) -> tuple[Problem, ...]:
    """Every finding of a pydantic validation as a field problem; `model`: what was validated, to say what it knows."""
    found = [d for d in error.errors(include_url=False) if not _other_form(d)]
    return tuple(problem for details in found for problem in several_of(details, prefix, model))


def several_of(details: ErrorDetails, prefix: str = "", model: type[BaseModel] | None = None) -> tuple[Problem, ...]:
    """One finding as field problems: those of a validator that names fields itself (SpecError), else one."""
    cause = details.get("ctx", {}).get("error")
    if isinstance(cause, SpecError):
        return cause.problems
    return (problem_of(details, prefix, model),)


def problem_of(details: ErrorDetails, prefix: str = "", model: type[BaseModel] | None = None) -> Problem:
    """One finding as a field problem."""
    parts = [*([prefix] if prefix else []), *_place(details["loc"])]
    context: Mapping[str, object] = details.get("ctx", {})
    given = None if details["type"] == "missing" else context.get("given", shown(details.get("input")))
    if details["type"] in TAGS:
        parts.append(str(context["discriminator"]).strip("'"))
        given = context.get("tag")
    parts += [str(context["field"])] if "field" in context else []
    field = ".".join(parts) or "request"
    unit = unit_of(field)
    message, allowed = _message(details), _allowed(context)
    if details["type"] == "extra_forbidden" and model is not None:
        known = fields_beside(model, details["loc"])
        name = str(details["loc"][-1])
        hint = _in_rpm(name, details.get("input"), known) or did_you_mean(name, known)
        message, allowed, unit = message + hint, ", ".join(known), ""
    if details["type"] == "missing":
        message += _rpm_beside(details.get("input"), field)
    if not allowed:
        expected = expected_at(model, details["loc"]) if model is not None else ""
        allowed = expected or WORDS.get(details["type"], ("", ""))[1] or demanded(message)
    message += _unit_hint(details.get("input"), field, context)
    return Problem(field=field, message=message, given=given, allowed=allowed, unit=unit)


def _place(loc: Sequence[int | str]) -> Iterator[str]:
    """The path as it was written: without the kind that validation puts behind a part of several kinds."""
    for i, part in enumerate(loc):
        kind = i and part in KINDS and (isinstance(loc[i - 1], int) or loc[i - 1] in OF_KINDS)
        if not kind and (loc[i - 1] if i else "") not in FORMS.get(str(part), ()):
            yield str(part)


def _other_form(details: ErrorDetails) -> bool:
    """Whether an object is found not to be the number that might have stood in its place: its own findings are told."""
    *_, place, form = ("", "", *details["loc"])
    return form == "float" and place in FORMS[form] and isinstance(details.get("input"), Mapping)


def shown(value: object) -> object:
    """A value as it may be put into an error: JSON-ready, finite, short."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float):
        return value if not isinstance(value, int) or abs(value) < 10**18 else f"{str(value)[:20]}..."
    if isinstance(value, Mapping):
        return f"an object with the keys {', '.join(str(k) for k in list(value)[:8])}" if value else "an empty object"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"a list of {len(value)}"
    text = str(value)
    return text if len(text) <= _MAX_GIVEN_CHARS else f"{text[:_MAX_GIVEN_CHARS]}..."


def _message(details: ErrorDetails) -> str:
    if details["type"] in TAGS:
        return TAGS[details["type"]]
    if details["type"] in WORDS:
        return WORDS[details["type"]][0]
    text = details["msg"].removeprefix("Value error, ")
    return text[:1].lower() + text[1:]


def _allowed(context: Mapping[str, object]) -> str:
    for key in ("expected", "expected_tags"):
        if key in context:
            return str(context[key])
    if "pattern" in context:
        pattern = str(context["pattern"])
        return WORDED.get(pattern, f"text matching {pattern}")
    bounds = [form.format(_number(context[key])) for key, form in _BOUNDS if key in context]
    lengths = [f"{k.replace('_', ' ')} {context[k]}" for k in ("min_length", "max_length") if k in context]
    return ", ".join([*bounds, *lengths])


def _number(value: object) -> str:
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def _unit_hint(value: object, field: str, context: Mapping[str, object]) -> str:
    """Recognise rpm where a frequency is too large, millimetres and micrometres where a length in metres is."""
    high = context.get("le", context.get("lt"))
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value <= 0:
        return ""
    if not isinstance(high, int | float):
        return ""
    if field.endswith("speed_hz") and value / 60 <= high:
        return f" (if rpm were meant: {value:g} rpm are {value / 60:g} Hz)"
    if unit_of(field) != "m":
        return ""
    for factor, name in ((1e-3, "mm"), (1e-6, "um")):
        if value * factor <= high:
            return f" (it would fit if meant in {name}; lengths are given in m)"
    return ""


def _rpm_beside(part: object, field: str) -> str:
    """Where a speed in Hz is missing, but one in rpm is there."""
    if not field.endswith("speed_hz") or not isinstance(part, Mapping):
        return ""
    for key, value in part.items():
        if "rpm" in str(key).lower() and isinstance(value, int | float) and not isinstance(value, bool):
            return f" ({str(key)[:40]} is given: {value:g} rpm are {value / 60:g} Hz)"
    return ""


def _in_rpm(name: str, value: object, known: Sequence[str]) -> str:
    """Of an unknown field that gives a speed in rpm: what is known instead, in Hz."""
    speed = next((field for field in known if field.endswith("speed_hz")), None)
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if speed is None or not number or "rpm" not in name.lower():
        return ""
    return f" (speeds are in Hz: {value:g} rpm are {speed} {value / 60:g})"  # type: ignore[operator]


class Findings:
    """Problems of several steps that do not need each other, so that they can be told together."""

    def __init__(self) -> None:
        self._problems: list[Problem] = []

    @contextmanager
    def step(self) -> Iterator[None]:
        """Keep the problems raised inside and go on."""
        try:
            yield
        except SpecError as error:
            self._problems += [problem for problem in error.problems if problem not in self._problems]

    def settle(self) -> None:
        """Raise what was kept, if anything."""
        if self._problems:
            raise SpecError(self._problems)
