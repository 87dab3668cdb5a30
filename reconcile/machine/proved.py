"""A name must be proved by simulation: the machine with it must be nearer to the recordings than without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.machine.beneath import set_aside
from reconcile.machine.decide import MECHANISM_OPEN, STRUCK, Decision
from reconcile.machine.direct import HEARD
from reconcile.machine.local import COSTLY
from reconcile.machine.revised import Revised
from reconcile.machine.setting import Found
from reconcile.machine.weigh import FAR_AHEAD, lead
from reconcile.verdict import Cause, HeldOut, Word
from sim.terms import REGISTRY

NO_NEARER = "the machine with the effect that fits best, simulated, is no nearer to the recordings than without it"
FAR_WORSE = 2.0
"""Times the levels' change that a machine with what strikes for sure may leave, simulated: right ones leave 0.3 to 1.4
of it; a sound rotor whose two sensors were exchanged, a race's pit for its evidence, 2.9."""
UNLIKE = (
    "impacts come at the lines of the effect that fits best, but the machine with it, simulated, is far off the "
    "recorded levels: another part, another place, or sensors that are not where they are said to be"
)
NO_FORECAST = "on data it was not fitted to, the effect that fits best brings the spectra no nearer than none"
NO_BETTER = (
    "on data it was not fitted to, the effect that fits best may bring the spectra no nearer than none, and a "
    "correction without physics brings them nearer"
)
BEYOND_DOUBT = 20.0
"""Log evidence, ahead of all else by `FAR_AHEAD`, from which an effect is there although no form of it that was
simulated comes nearer: sound machines come to 7.0 with a friction, a loose seat of another machine (o016), whose level
change of 2.9 dB none of seven forms met, to 38.5 and 21 ahead."""
MOST_KEPT = 0.7
"""Share of the single lines' change that what rattles must explain, leaving no more than it should, for its name to
stand although it foretells nothing: how far a loose ring moves in the direction in which it is free is another form's
affair (bk069 of the proof, a fit of 11.5 um: lines 0.77, 16.2 against 5.6, and in the ring's own direction at one speed
8 to 14 dB off, of 8.4)."""
FORM_UNMET = "the effect is there, but no form of it that was simulated is nearer to the recorded levels than none"


def proved(
    decision: Decision, causes: tuple[Cause, ...], found: Found, revised: Revised | None, held: HeldOut | None = None
) -> tuple[Decision, tuple[Cause, ...]]:
    """The same where nothing is named or the name stands; else not decidable, and nothing named.

    Of sixteen cases of the proof in which the right effect is named, simulated it leaves 0.31 to 0.92 of the levels'
    change, and once, where the effect is in few lines of eight sensors, 0.99; a sound machine heard by eight sensors at
    five speeds, to which a friction was fitted, 1.12 of it. Where an effect strikes for sure its impacts have proved
    it: levels within the usual need not come nearer, but what leaves twice the change is not it.

    So it is of a set whose best effect does not stand far out either: a sound machine heard by eight sensors showed a
    rub or three others with evidence 3.7, and 3.73 of 3.69 dB left; sets with the right effect first and no nearer had
    10 and 21. A name that stands beyond doubt stays too, and its cause says that its form is not met.

    A name alone must foretell, too (`held`): of 56 of the proof that were right and do not strike, at its target
    condition, each gained on data held out, if only 0.02; a rub told of a cracked tooth, nearer by 6 % of the levels'
    change, lost 0.08. At one speed and 10 dB a right one lost 0.07 (l030, a loose seat): that is not named any more.
    """
    if decision.word not in ("explained", "ambiguous") or revised is None:
        return decision, causes
    place = found.screen.names.index(decision.chosen[0])
    struck = float(found.screen.direct[place]) >= (HEARD if _of_a_tooth(decision) else STRUCK)
    sure = float(found.screen.evidence[place]) >= BEYOND_DOUBT and lead(found.screen) >= FAR_AHEAD
    if revised.after_db < revised.before_db:
        met = _rattles_as_told(decision, found)
        nothing = "" if struck or sure or met else _foretells_nothing(decision, held)
        return _undecided(decision, causes, found, nothing) if nothing else (decision, causes)
    if struck and revised.after_db >= FAR_WORSE * revised.before_db:
        return replace(decision, word="not_decidable", reasons=(UNLIKE,)), _unnamed(causes, UNLIKE)
    firm = decision.word == "ambiguous" and float(found.screen.evidence[place]) >= FAR_AHEAD
    if struck or firm:
        return decision, causes
    if sure:
        first, *others = causes
        return decision, (replace(first, reasons=(*first.reasons, FORM_UNMET)), *others)
    return _undecided(decision, causes, found, NO_NEARER)


def _foretells_nothing(decision: Decision, held: HeldOut | None) -> str:
    """Why an effect that is named alone says nothing of data that were held out; empty where it does, or where it was
    not tried."""
    if decision.word != "explained" or held is None or held.effects != decision.chosen[:1]:
        return ""
    if held.gain <= 0.0:
        return NO_FORECAST
    beaten = held.black_box is not None and held.black_box > held.gain
    return NO_BETTER if beaten and held.gain_low <= 0.0 else ""


def _rattles_as_told(decision: Decision, found: Found) -> bool:
    """Whether the one effect is a loose ring, far ahead of all others, whose lines are met."""
    first, rest = decision.chosen[0].split("@")[0], found.screen.rest
    met = rest.unmet == 0.0 and rest.kept >= MOST_KEPT
    return len(decision.chosen) == 1 and first in COSTLY and met and lead(found.screen) >= FAR_AHEAD


def _undecided(
    decision: Decision, causes: tuple[Cause, ...], found: Found, reason: str
) -> tuple[Decision, tuple[Cause, ...]]:
    """Nothing named, but for the teeth whose burst was set aside: what it stood beside is not proved, it is."""
    teeth = set_aside(found.screen)
    if teeth:
        word: Word = "ambiguous" if len(teeth) > 1 else "explained"
        return replace(decision, word=word, chosen=teeth, reasons=(MECHANISM_OPEN,)), _teeth_first(causes, teeth)
    return replace(decision, word="not_decidable", reasons=(reason,)), _unnamed(causes, reason)


def _of_a_tooth(decision: Decision) -> bool:
    """Whether all that is left open are faults of teeth: a burst at one place of the turn is told from far below what
    moves a level."""
    teeth = {term.key for term in REGISTRY if term.strikes == "tooth"}
    return all(name.split("@")[0] in teeth for name in decision.chosen)


def _teeth_first(causes: Sequence[Cause], teeth: Sequence[str]) -> tuple[Cause, ...]:
    """What their burst proves, then the rest; one fault alone is named."""
    own = [c for name in teeth for c in causes if f"{c.term}@{c.site}" == name]
    rest = [c for c in causes if c not in own]
    kept = [replace(c, named=len(teeth) == 1, reasons=(MECHANISM_OPEN,)) for c in own]
    return (*kept, *_unnamed(rest))


def _unnamed(causes: Sequence[Cause], reason: str = NO_NEARER) -> tuple[Cause, ...]:
    return tuple(replace(c, named=False, reasons=(reason,)) for c in causes)
