"""Machines with both effects: where an ensemble begins, and what it shows once it is led to the observation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.atlas.candidates import Candidate
from reconcile.machine.asked import TEMPER, Asked
from reconcile.machine.assimilate import Ensemble, moved, simulated_again
from reconcile.machine.pairs import Simulated, evidence_in

DRAWS = 3
"""The second effect's draws that start an ensemble, in turn."""


def start_of(asked: Asked, rows: Sequence[int], second: str) -> Ensemble:
    """The first's nearest draws, with the best of the `second` in turn if there are `rows` of one; half of them are
    what fits best in sum: alone, the first is as large as it must be to explain the second too."""
    every, changes = asked.every, asked.setting.changes
    own = [k for k in every.library.groups[asked.first] if k >= asked.local]
    told = evidence_in(asked.found.fitted, every.library.changes[own], changes.observed)
    near = [own[k] for k in np.argsort(-told)[: asked.members]]
    a = [near[k % len(near)] for k in range(asked.members)]
    b = [rows[k % min(DRAWS, len(rows))] for k in range(asked.members)] if second else []
    if second and not asked.beside_impacts:  # whose lines say nothing of how large the first is
        half = asked.members // 2
        summed = best_sums(asked, own, rows[:DRAWS])[: asked.members - half]
        a[half : half + len(summed)], b[half : half + len(summed)] = zip(*summed, strict=True)
    term, site = asked.first.split("@")
    shown = every.library.changes[a]
    return Ensemble(
        candidate=Candidate(term=term, site=site),
        offsets=tuple(every.offsets[k] for k in a),
        terms=tuple(every.terms[k] for k in a),
        also=tuple(every.terms[k] for k in b),
        changes=changes.both(shown, every.library.changes[b]) if second else shown,
    )


def best_sums(asked: Asked, firsts: Sequence[int], seconds: Sequence[int]) -> list[tuple[int, int]]:
    """Draws of both whose sums are likeliest, the best first, every first once."""
    library = asked.every.library.changes
    told = np.array(
        [asked.left.likelihood(asked.setting.changes.both(library[[a]], library[list(seconds)])) for a in firsts]
    )
    order = np.argsort(-told.max(axis=1))
    return [(firsts[int(k)], seconds[int(np.argmax(told[k]))]) for k in order]


def led_again(asked: Asked, start: Ensemble, second: str) -> Simulated | None:
    """These machines and effects led to the observation, simulated; None where too few run."""
    setting, left = asked.setting, asked.left
    rng = np.random.default_rng([setting.seed, 23, *f"{asked.first}+{second}".encode()])
    led = moved(start, asked.view, setting.changes.observed, 1.0, rng)
    if asked.beside_impacts:  # of which the teeth's lines say nothing
        led = replace(led, terms=start.terms)
    more = simulated_again(setting, led.candidate, led.offsets, led.terms, asked.mapper, also=led.also)
    if more is None:
        return None
    gains = (left.likelihood(more.library.changes) - left.base) / TEMPER
    return Simulated(known=more, also=led.also, gains=gains)
