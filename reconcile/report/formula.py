"""Names of lines as one writes them by hand: `3*f_i1-2*f_r1` with its signs and lowered indices."""

from __future__ import annotations

import re

from reconcile.report.markup import Markup, escaped, tag

INDEXED = re.compile(r"\bf_(\w+)")
TIMES = re.compile(r"(?<=\d)\*(?=f_)")
SIGN = re.compile(r"(?<=\w)\s?([-+±])\s?(?=\d+\*f_|f_)")
SIGNS = {"-": "−"}


def drawn_formula(label: str) -> str:
    """The same for a figure, whose text has no lowered indices: `3 f_i1 − 2 f_r1`."""
    return TIMES.sub("\u00a0", SIGN.sub(lambda m: f" {SIGNS.get(m[1], m[1])} ", label))


def formula(label: str) -> Markup:
    """A label, or a text with labels in it, as markup; other words stay as they are."""
    spaced = SIGN.sub(lambda m: f" {SIGNS.get(m[1], m[1])} ", label)
    return Markup(INDEXED.sub(lambda m: tag("i", "f") + tag("sub", m[1]), TIMES.sub("\u00a0", escaped(spaced))))
