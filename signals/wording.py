"""Pydantic's kinds of findings in our words: what is wrong, and what is taken where the finding itself does not say."""

from __future__ import annotations

from collections.abc import Mapping

_NUMBER = ("is not a number", "a number")
_WHOLE = ("is not a whole number", "a whole number")
_TRUTH = ("is neither true nor false", "true or false")
_OBJECT = ("is not an object", "an object")
_LIST = ("is not a list", "a list")
_SMALL, _LARGE = ("is too small", ""), ("is too large", "")
_CHOICE = ("is not one of those that are taken", "")

WORDS: Mapping[str, tuple[str, str]] = {
    **dict.fromkeys(("float_type", "float_parsing"), _NUMBER),
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float", "int_parsing_size"), _WHOLE),
    **dict.fromkeys(("bool_type", "bool_parsing"), _TRUTH),
    **dict.fromkeys(("dict_type", "model_type", "model_attributes_type", "mapping_type", "dataclass_type"), _OBJECT),
    **dict.fromkeys(("list_type", "tuple_type"), _LIST),
    **dict.fromkeys(("greater_than", "greater_than_equal"), _SMALL),
    **dict.fromkeys(("less_than", "less_than_equal"), _LARGE),
    **dict.fromkeys(("literal_error", "enum"), _CHOICE),
    "string_type": ("is not text", "text"),
    "string_too_short": ("is too short", ""),
    "string_too_long": ("is too long", ""),
    "too_short": ("has too few items", ""),
    "too_long": ("has too many items", ""),
    "finite_number": ("is not a finite number", "a finite number"),
    "extra_forbidden": ("is not a known field", ""),
    "missing": ("is required", ""),
    "string_pattern_mismatch": ("is no name as these are written", ""),
}
"""Message, and what is allowed, by the kind of finding."""
_MUST = "must be "


def demanded(message: str) -> str:
    """What a rule of ours allows, read off its own message: `must be X`, or the whole of `give X`."""
    if message.startswith(_MUST):
        return message.removeprefix(_MUST)
    return message if message.startswith(("give ", "needs ", "need ")) else ""
