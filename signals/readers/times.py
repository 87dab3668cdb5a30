"""Columns that are a time by their name or unit, which nobody mentioned."""

from __future__ import annotations

import re
from dataclasses import dataclass

from signals.readers.contents import Contents
from signals.units import find_unit

NAMES = frozenset(
    {
        *("time", "times", "timestamp", "timestamps", "time stamp", "time stamps", "elapsed", "elapsed time"),
        *("x value", "zeit"),
    }
)
"""Without their unit, in lower case; `X_Value` is how LabVIEW calls the time of a waveform."""
LETTER = "t"
"""The one name in which case counts: T is a temperature as often."""
_WORDS = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("us", "µs", "μs", "usec", "microsecond", "microseconds"), "us"),
    **dict.fromkeys(("ns", "nsec", "nanosecond", "nanoseconds"), "ns"),
}
_BRACKETS = re.compile(r"^(?P<name>.*?)\s*[\[(<{](?P<unit>[^\])>}]*)[\])>}]$")
_TAIL = re.compile(r"^(?P<name>.+?)\s*[_,/\- ]\s*(?P<unit>[^_,/\- ]+)$")
_APART = re.compile(r"[_\-\s]+")


@dataclass(frozen=True, kw_only=True)
class Named:
    """What a column's heading says of it: that it is a time, and in which unit, empty if in none that is known."""

    unit: str


def named_time(heading: str) -> Named | None:
    """A heading as people and programs write it (`Time (s)`, `time_ms`, `Seconds`); None: no time by its name."""
    text = heading.strip()
    above, _, last = text.rpartition("/")  # a path in the file, or `Time / s`
    text = last.strip() if above and last.strip().casefold() not in _WORDS else text
    bracketed = _BRACKETS.match(text)
    if bracketed:
        return _named(bracketed["name"], bracketed["unit"].strip())
    whole = _named(text, "")
    tail = _TAIL.match(text)
    if whole is None and tail and tail["unit"].casefold() in _WORDS:
        return _named(tail["name"], tail["unit"])
    return whole


def _named(name: str, unit: str) -> Named | None:
    name = name.rpartition("/")[2].strip()
    plain, word = _APART.sub(" ", name.casefold()), _WORDS.get(unit.casefold(), "")
    if name == LETTER:
        return Named(unit=word) if word or not unit else None
    if plain in NAMES:
        return Named(unit=word)
    alone = _WORDS.get(plain, "") if len(plain) > len("ms") else ""
    return Named(unit=alone) if alone and not unit else None


def of_time(unit: str) -> bool:
    """Whether the text is a unit of time."""
    found = find_unit(unit) if unit else None
    return found is not None and found.quantity == "time"


def times_of(contents: Contents, taken: frozenset[str]) -> list[str]:
    """Arrays besides those `taken` that are a time by their name, then those by their unit alone, then a table's first
    column whatever its name."""
    free = [name for name in contents.entries if name not in taken]
    named = [name for name in free if named_time(name) is not None]
    by_unit = [name for name in free if name not in named and of_time(contents.entries[name].unit)]
    first = next(iter(contents.entries), None)
    table = contents.numbered and contents.together is not None  # columns of text, no sound file
    leading = [first] if table and first in free and first not in {*named, *by_unit} else []
    return [*sorted(named), *by_unit, *leading]
