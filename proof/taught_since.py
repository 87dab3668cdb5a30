"""What the latest plans taught, as in `proof.taught`."""

from __future__ import annotations

SINCE = (
    (
        "a name without impacts that brings the spectra no nearer on data held out is no name",
        "m013, a cracked tooth told as a rub by commit f19aa093, which had met it; not decidable since",
    ),
    (
        "a line near the teeth's must be louder than its foot ([decision](decisions/reconcile-own-order.md))",
        "x045, an unbalance too faint to show, told as an order of no part: the end of a skirt; nothing missing since",
    ),
    (
        (
            "lines that changed for sure and are like no known effect's are none's, however little one leaves of them; "
            "what is left of lines that did not says nothing "
            "([decision](decisions/reconcile-refused.md))"
        ),
        (
            "x034, x043, c045, i070 and w055, effects that no library has, not decidable before (and z036, a known "
            "one); h034, a sound machine told as unknown physics"
        ),
    ),
    (
        (
            "lines to which an effect was not fitted are unknown physics from three times the usual on "
            "([decision](decisions/reconcile-refused.md))"
        ),
        "x032, a parallel offset told as unknown physics; not decidable since",
    ),
    (
        "lines of a struck bearing's cage are no second part ([decision](decisions/reconcile-pairs-measured.md))",
        "x001, a pit beside which another bearing's was named that is not there",
    ),
    (
        (
            "at one operating point nothing that strikes nowhere stands beside a first that is open "
            "([decision](decisions/reconcile-pairs-measured.md))"
        ),
        "x024, a loose ring and a cracked tooth named a wider clearance and a cracked shaft; a set there since",
    ),
    (
        (
            "from 12 of log evidence on, the little that an effect leaves of lines is a remark "
            "([decision](decisions/reconcile-refused.md))"
        ),
        "tw052, a loose ring, not decidable before, named since; tw010, a loose foot, in a set since",
    ),
    (
        (
            "an order of no part that rose clearly goes before a name whose revised machine leaves all of the change "
            "([decision](decisions/reconcile-own-order.md))"
        ),
        "tw039, a belt told as a torque and a run-out; unknown physics since",
    ),
    (
        "what by its sum comes near the best that is simulated is too ([decision](decisions/reconcile-leftover.md))",
        "tw045, a pit and a loose ring, opened by a foot in a version that simulated fewer rings",
    ),
    (
        (
            "what no drawing says of a loose ring is searched wider, and a ring far ahead that meets its lines need "
            "not foretell how it rattles ([decision](decisions/reconcile-rattle.md))"
        ),
        "bk001 and bk069, loose rings, not decidable before, named since; bk059, a set with the ring first since",
    ),
    (
        (
            "a sure driving effect that leaves too much is asked for what it makes rattle "
            "([decision](decisions/reconcile-interplay.md))"
        ),
        "y072, an unbalance in a loose ring, unknown physics before; both named since",
    ),
    (
        (
            "a pit of which both edges are heard is as long as the angle between a ball's two strikes "
            "([decision](decisions/reconcile-strikes.md))"
        ),
        "the pits of `baker` and `chandler`, half of which were told too large or too small by more than 0.32",
    ),
)
"""A rule, and the cases that set it."""
