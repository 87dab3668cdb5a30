"""Draws of one or several plans as a library of changes seen through the sensors at hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.bank import Bank
from reconcile.atlas.candidates import size_parameter, size_range
from reconcile.atlas.plan import AtlasPlan, Draw
from reconcile.calibrate.uncertain import Offsets
from reconcile.judge.changes import Lens, signatures
from reconcile.judge.space import Library
from sim.core.errors import Problem, SpecError
from sim.core.spec import TermSpec
from sim.terms import REGISTRY


@dataclass(frozen=True, kw_only=True)
class Catalogued:
    """A library with the simulated term of each row, the number of the healthy machine it stands on and how that one
    is moved (none where these are not asked)."""

    library: Library
    terms: tuple[TermSpec, ...]
    pairs: tuple[int, ...] = ()
    offsets: tuple[Offsets, ...] = ()


def share_of(draw: Draw) -> float:
    """Logarithmic size of a draw within the range sought, 0..1 (refined draws may leave it)."""
    term = REGISTRY.get(draw.candidate.term) if draw.candidate is not None else None
    if term is None or draw.term is None:
        raise ValueError("a healthy draw has no size")
    size = size_parameter(term)
    low, high = size_range(size)
    value = max(float(draw.term.parameters[size.name]), 1e-3 * low)
    return float(np.log(value / low) / np.log(high / low))


def catalogued(
    plan: AtlasPlan,
    banks: Sequence[Bank],
    seen_through: Sequence[Lens],
    healthy_plan: AtlasPlan,
    healthy_banks: Sequence[Bank],
    *,
    with_baseline: bool,
) -> Catalogued:
    """Rows of all candidates that could be simulated at every point, with their own healthy machines subtracted.

    Against a baseline without what a machine has from its first day: it cannot have come since.
    """
    alive = np.all([b.alive for b in banks], axis=0)
    rested = np.all([b.alive for b in healthy_banks], axis=0)
    first = {d.pair: k for k, d in enumerate(healthy_plan.draws) if d.candidate is None and not d.twin}
    rows = [
        k
        for k, d in enumerate(plan.draws)
        if d.candidate is not None
        and alive[k]
        and rested[first[d.pair]]
        and not (with_baseline and _lasting(d.candidate.term))
    ]
    if not rows:
        message = "no candidate effect could be simulated on this machine"
        raise SpecError(Problem(field="machine", message=message, allowed="a machine whose effects can be simulated"))
    changes = signatures(seen_through, banks, plan, rows, healthy_banks, healthy_plan, with_baseline=with_baseline)
    groups: dict[str, list[int]] = {}
    terms = []
    for place, k in enumerate(rows):
        draw = plan.draws[k]
        if draw.candidate is not None and draw.term is not None:
            groups.setdefault(draw.candidate.label, []).append(place)
            terms.append(draw.term)
    library = Library(
        changes=changes,
        groups={name: tuple(members) for name, members in groups.items()},
        shares=np.array([share_of(plan.draws[k]) for k in rows]),
    )
    pairs = tuple(plan.draws[k].pair for k in rows)
    return Catalogued(
        library=library, terms=tuple(terms), pairs=pairs, offsets=tuple(plan.offsets[pair] for pair in pairs)
    )


def _lasting(key: str) -> bool:
    term = REGISTRY.get(key)
    return term is not None and term.lasting


def joined(first: Catalogued, second: Catalogued) -> Catalogued:
    """Both libraries' draws; effects of the same name share a path."""
    offset = len(first.terms)
    groups = {name: tuple(rows) for name, rows in first.library.groups.items()}
    for name, rows in second.library.groups.items():
        groups[name] = (*groups.get(name, ()), *(offset + r for r in rows))
    library = Library(
        changes=np.concatenate([first.library.changes, second.library.changes]),
        groups=groups,
        shares=np.concatenate([first.library.shares, second.library.shares]),
    )
    return Catalogued(
        library=library,
        terms=(*first.terms, *second.terms),
        pairs=(*first.pairs, *second.pairs),
        offsets=(*first.offsets, *second.offsets),
    )
