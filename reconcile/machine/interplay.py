"""Seconds that act on the first effect, asked by simulation where sums cannot tell them.

A loose ring, a worn bearing or a loose foot rattles under an unbalance, and shows then what neither shows alone: sums
of the two miss it, and so may name another second or none. Where a force that turns or shakes comes first, these are
therefore simulated beside it once, at two sizes each and with the first smaller than it is alone; of the likeliest two
the sizes of both are searched.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.atlas.candidates import size_parameter
from reconcile.machine.asked import Asked
from reconcile.machine.assimilate import Ensemble, simulated_again
from reconcile.machine.decide import Decision
from reconcile.machine.refine import known_term
from reconcile.machine.setting import Found
from reconcile.machine.sizes import sized
from reconcile.machine.weigh import exclusive
from sim.core.spec import TermSpec

RATTLING = ("fit_clearance_series", "pedestal_looseness", "radial_clearance")
"""Terms with a play that a force opens and closes."""
DRIVING = ("unbalance", "bent_shaft", "eccentricity", "parallel_misalignment", "angular_misalignment", "torque_ripple")
"""Terms that force a motion, whatever else there is."""
SHARE = 0.6
"""The first's size beside a second, of what it is alone: in three cases of the proof 0.5, 0.6 and 0.7."""
SIZES = (0.3, 0.7)
"""Where between the draws' sizes, counted, those that are simulated stand."""
TRIED, NEAR = 2, 30.0
"""Of how many seconds at most the sizes are searched: of the likeliest, and of what is so near it."""
FAINT = 0.0
"""Log likelihood over the first alone from which on the likeliest is searched: right ones stood at 39, 58 and 354,
beside an unbalance alone none above -71."""


SHAKEN = 20.0
"""Log evidence of a driving effect from which it is looked for what it makes rattle, though it leaves too much itself:
of two plans of the proof effects that no library has come to 8 at most, an unbalance in a loose ring (y072) to 32."""


def drives(name: str) -> bool:
    """Whether an effect forces a motion."""
    return name.split("@", maxsplit=1)[0] in DRIVING


def rattles(name: str) -> bool:
    """Whether an effect has a play."""
    return name.split("@", maxsplit=1)[0] in RATTLING


def shaken(found: Found, decision: Decision) -> bool:
    """Whether no known effect is adequate, but one that forces a motion is sure to be there: what it makes rattle shows
    what neither shows alone. What no library has seldom comes with as much evidence of such a one."""
    if decision.word != "unknown_physics" or not decision.chosen or not drives(decision.chosen[0]):
        return False
    told = dict(zip(found.screen.names, map(float, found.screen.evidence), strict=True))
    return told[decision.chosen[0]] >= SHAKEN


def interplaying(asked: Asked, start: Ensemble) -> Mapping[str, tuple[int, ...]]:
    """The likeliest seconds that a driving first may make rattle, the best first, each with its rows of `asked.every`,
    the likeliest first; none where the first drives nothing or too few run. `start`: machines with the first alone."""
    if not drives(asked.first):
        return {}
    rows = [k for name in _names(asked) for k in _two_of(asked, name)]
    if not rows:
        return {}
    count = len(start.terms)
    firsts = [_smaller(start.terms[k % count]) for k in range(len(rows))]
    offsets = [start.offsets[k % count] for k in range(len(rows))]
    seconds = [asked.every.terms[k] for k in rows]
    made = simulated_again(asked.setting, start.candidate, offsets, firsts, asked.mapper, also=seconds)
    if made is None:
        return {}
    told = asked.left.likelihood(made.library.changes)
    found: dict[str, list[int]] = {}
    best: dict[str, float] = {}
    for k in np.argsort(-told):
        row = rows[made.pairs[int(k)]]
        term = asked.every.terms[row]
        name = f"{term.term}@{term.site}"
        found.setdefault(name, []).append(row)
        best.setdefault(name, float(told[k]))
    least = max(FAINT + asked.left.base, max(best.values()) - NEAR)
    return {name: tuple(found[name]) for name in list(found)[:TRIED] if best[name] >= least}


def _names(asked: Asked) -> list[str]:
    groups = asked.every.library.groups
    return [n for n in groups if rattles(n) and not exclusive(n, asked.first)]


def _two_of(asked: Asked, name: str) -> Sequence[int]:
    """Rows of a small and a large one."""
    rows = list(asked.every.library.groups[name])
    size = size_parameter(known_term(name.split("@", maxsplit=1)[0])).name
    order = np.argsort([abs(asked.every.terms[k].parameters[size]) for k in rows])
    return list(dict.fromkeys(rows[int(order[round(share * (len(rows) - 1))])] for share in SIZES))


def _smaller(term: TermSpec) -> TermSpec:
    size = size_parameter(known_term(term.term))
    return sized(term, size, SHARE * term.parameters[size.name])
