"""Which draws of a loose ring are simulated again.

What a ring does to the levels that machines of the kind share hangs on its gap; how far it rattles by itself hangs on
damping and friction as well, of which these levels say nothing. Of the draws that are about as near as the nearest in
the view that speaks for it, those go on that are likeliest feature by feature.
"""

from __future__ import annotations

import numpy as np

from reconcile.machine.leftover import over_nothing
from reconcile.machine.local import COSTLY
from reconcile.machine.pairs import evidence_in
from reconcile.machine.refine import best_draws
from reconcile.machine.setting import Found, Setting
from sim.core.spec import TermSpec

AS_NEAR = 4.0
"""Log evidence behind the nearest draw up to which another is as near: of a loose fit of 11.5 um (bk069 of the proof)
11 of 16 draws came so near, of 4 to 20 um; in the ring's own direction they left 8 to 20 dB of 8.4."""
AROUND = 3


def draws_around(setting: Setting, found: Found, name: str, count: int = AROUND) -> list[TermSpec]:
    """So many draws of an effect about which it is simulated again: the nearest; of a loose ring the likeliest of
    those about as near, then the nearest."""
    observed = setting.changes.observed
    if name.split("@", maxsplit=1)[0] not in COSTLY:
        return best_draws(found.view(name), found.known, name, observed, count)
    view, rows = found.view(name), list(found.known.library.groups[name])
    changes = found.known.library.changes[rows]
    told = evidence_in(view, changes, observed)
    likely = np.where(told >= told.max() - AS_NEAR, over_nothing(setting.changes, changes), -np.inf)
    order = np.lexsort((-told, -likely))
    return [found.known.terms[rows[k]] for k in order[:count]]
