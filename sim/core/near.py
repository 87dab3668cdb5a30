"""Names that a slip of the pen may have meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LIKE = 0.6
"""Least similarity (difflib's ratio) of a name that is suggested."""
MOST = 4


def near(name: str, known: Iterable[str], *, most: int = MOST, like: float = LIKE) -> list[str]:
    """The known names that are like `name`, the likest first; names are compared without regard to case."""
    folded = {candidate.casefold(): candidate for candidate in known}
    return [folded[found] for found in difflib.get_close_matches(name[:80].casefold(), folded, n=most, cutoff=like)]


def likest(name: str, known: Iterable[str]) -> list[str]:
    """Of these, the likest; several where they are equally like, as `bearing1` and `bearing2` are to `bearing9`."""
    found = near(name, known)

    def ratio(candidate: str) -> float:
        return difflib.SequenceMatcher(None, candidate.casefold(), name[:80].casefold()).ratio()

    return sorted(candidate for candidate in found if ratio(candidate) >= ratio(found[0]) - 1e-9)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """` (did you mean a or b?)`, or nothing."""
    found = likest(name, known)
    listed = " or ".join([", ".join(found[:-1]), found[-1]] if len(found) > 1 else found)
    return f" (did you mean {listed}?)" if found else ""
