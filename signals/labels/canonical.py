"""Merging lines that are identical by construction into one candidate in its simplest physical form."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from signals.labels.families import MECHANISM
from signals.labels.identity import VectorKey, base_vectors, vector_key
from signals.labels.kinematics import Kinematics
from signals.spectra.types import Spectrum
from signals.windows import MAIN_LOBE_BINS
from sim.core.lines import Line, Order

FAMILY_ORDER = ("f_m", "f_o", "f_i", "f_b", "f_c", "f_r")
"""Order of the bases in a label (carriers before what modulates them), and of preference between equal weights."""
IN_BEARINGS = frozenset({"outer", "inner", "ball", "cage"})
"""Families of the parts of a bearing."""
HEALTHY = frozenset({"ball_contact"})
"""What every bearing does: named after a term that someone put into the machine, where both make a line."""
Series = frozenset[str]
"""The bases of a line: its family of multiples and sidebands."""
_BASE = re.compile(r"^(?P<family>[a-z]_[a-z])(?P<index>\d*)$")


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A canonical line: one frequency, every form, component and mechanism it may come from (simplest first).

    `component`: the only one, or that of the defect which names a bearing's line; None where several may make it.
    `predicted`: a term of the physics predicts this very line. `families`: component and first base of each of its
    forms, as (`bearing1`, `f_i1`): what has to be found together where nothing predicts it.
    """

    label: str
    orders: tuple[tuple[str, Order], ...]
    frequency_hz: float
    family: str
    mechanism: str
    component: str | None
    components: tuple[str, ...]
    mechanisms: tuple[str, ...]
    aliases: tuple[str, ...]
    predicted: bool
    families: tuple[tuple[str, str], ...]

    @property
    def weight(self) -> int:
        """How far-fetched the sum is."""
        return weight_of(self.orders)


@dataclass(frozen=True, kw_only=True)
class Told:
    """What terms say of the lines made of some bases: their mechanisms, the family they count to, and the `makers`,
    components each with a mechanism.
    """

    mechanisms: tuple[str, ...]
    family: str
    makers: frozenset[tuple[str, str]] = frozenset()


def told_series(lines: Iterable[Line]) -> dict[Series, Told]:
    """By bases: a term that predicts some multiples speaks for all, so that harmonics of one family read alike."""
    found: dict[Series, Told] = {}
    for line in lines:
        if line.mechanism != MECHANISM:
            series = frozenset(base for base, n in line.orders if n)
            known = found.get(series, Told(mechanisms=(), family=line.family))
            mechanisms = tuple(dict.fromkeys((*known.mechanisms, line.mechanism)))
            makers = known.makers | {(line.component, line.mechanism)}
            found[series] = replace(known, mechanisms=mechanisms, makers=makers)
    return found


def merge_lines(
    lines: Iterable[Line], bases_hz: Mapping[str, float], kinematics: Kinematics | None = None
) -> tuple[Candidate, ...]:
    """Canonical candidates sorted by frequency. A sum that is zero by construction is no line."""
    lines = list(lines)
    told = told_series(lines)
    vectors = base_vectors(kinematics or Kinematics())
    groups: dict[VectorKey, list[Line]] = {}
    for line in lines:
        ordered = _ordered(line)
        key = vector_key(ordered.orders, vectors)
        if key:
            # a sum and its negative are one line: the frequency folds
            groups.setdefault(min(key, tuple((symbol, -share) for symbol, share in key)), []).append(ordered)
    merged = [_candidate(group, bases_hz, told) for group in groups.values()]
    return tuple(sorted(merged, key=lambda c: (c.frequency_hz, c.label)))


def inside(candidates: Sequence[Candidate], spectrum: Spectrum) -> tuple[Candidate, ...]:
    """Candidates a main lobe away from zero frequency and from the end of the axis."""
    lobe = MAIN_LOBE_BINS[spectrum.window] * spectrum.resolution_hz
    top = float(spectrum.frequency_hz[-1])
    return tuple(c for c in candidates if lobe <= c.frequency_hz <= top - lobe)


def weight_of(orders: Sequence[tuple[str, Order]]) -> int:
    """Sum of |orders|; a fraction p/q counts |p| + q - 1, so that a half is no simpler than the whole."""
    return sum(abs(n.numerator) + n.denominator - 1 for _, n in orders)


def simplicity(orders: Sequence[tuple[str, Order]]) -> tuple[int, int, tuple[tuple[int, int, str], ...]]:
    """Sort key, smallest first: sum of |orders|, number of bases, then mesh before bearing before shaft."""
    return weight_of(orders), len(orders), tuple(_rank(base) for base, _ in orders)


def _ordered(line: Line) -> Line:
    """The line with its bases in canonical order, zeros dropped, and the first multiple positive."""
    totals: dict[str, Order] = {}
    for base, n in line.orders:
        totals[base] = totals.get(base, 0) + n
    orders = tuple(sorted(((b, n) for b, n in totals.items() if n), key=lambda item: _rank(item[0])))
    if orders and orders[0][1] < 0:
        orders = tuple((b, -n) for b, n in orders)
    return Line(orders=orders, component=line.component, mechanism=line.mechanism, family=line.family)


def _candidate(group: Sequence[Line], bases_hz: Mapping[str, float], told: Mapping[Series, Told]) -> Candidate:
    # A term's own prediction names the line before the mere kinematics do; the form stays the simplest.
    ordered = sorted(group, key=lambda x: (simplicity(x.orders), x.mechanism == MECHANISM))
    first = ordered[0]
    labels = tuple(dict.fromkeys(x.label for x in ordered))
    known = [told[series] for x in ordered if (series := _series(x)) in told]
    spoken = dict.fromkeys(m for t in known for m in t.mechanisms)
    mechanisms = tuple(sorted(spoken, key=lambda m: m in HEALTHY)) or (MECHANISM,)
    family = told[_series(first)].family if _series(first) in told else first.family
    components = tuple(dict.fromkeys(x.component for x in ordered))
    return Candidate(
        label=first.label,
        orders=first.orders,
        frequency_hz=first.frequency_hz(bases_hz),
        family=family,
        mechanism=mechanisms[0],
        component=components[0] if len(components) == 1 else _site(known, mechanisms[0], family),
        components=components,
        mechanisms=mechanisms,
        aliases=labels[1:],
        predicted=any(x.mechanism != MECHANISM for x in group),
        families=tuple(dict.fromkeys((x.component, x.orders[0][0]) for x in ordered)),
    )


def _site(known: Sequence[Told], mechanism: str, family: str) -> str | None:
    """Where the defect sits that names a line of several equal bearings, if it sits in one only."""
    sites = {site for told in known for site, by in told.makers if by == mechanism}
    return sites.pop() if family in IN_BEARINGS and mechanism not in HEALTHY and len(sites) == 1 else None


def _series(line: Line) -> Series:
    return frozenset(base for base, _ in line.orders)


@lru_cache(maxsize=1024)
def _rank(base: str) -> tuple[int, int, str]:
    match = _BASE.match(base)
    if match is None or match["family"] not in FAMILY_ORDER:
        return len(FAMILY_ORDER), 0, base
    return FAMILY_ORDER.index(match["family"]), int(match["index"] or 0), base
