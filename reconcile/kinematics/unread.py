"""Reports where neither pulses, nor lines of the shaft, nor a baseline say how fast the machine turned.

A name hangs on the stated speed then. It stands only if no other speed near by makes the impacts those of another part
as well; where one does, all of them are told with the speed that each needs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from reconcile.kinematics.answer import PARTS
from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.other_speeds import SPAN
from reconcile.shares import percent
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report, Where

ALIKE_Z = 1.5
"""Robust deviations that two scores must differ by to be told apart: each scatters by about one, from record to record
and by the choice of the controls, their difference by the root of two times that."""
BEHIND_Z = 3.0
"""Of the firmest: another part this far behind it is not told."""
SAME_LINES = 0.01
"""Relative difference of rates that are those of one train of impacts."""
SURE_Z, SURE_CHANCE, SURE_OFF = 10.0, 0.05, 0.01
"""Score of a shaft's turn over orders of no part, its chance, and how far off the stated speed it may stand, to confirm
that beside a part that stands. With an inner and an outer race of a motor it scores 34 and 11.5 at the right speed
(chances below 0.02), at labels 3 to 8 % off at most 1.5, 2 % off 11.0 at an order 1.2 % off, where the search ends."""
TACHO = NextExperiment(sentence="Record with a tacho, or read the speed once with a strobe.")


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A report with the candidates it was drawn from."""

    report: Report
    every: tuple[Candidate, ...]

    @property
    def z(self) -> float:
        """Score of the firmest bearing defect that stands, else 0."""
        return 0.0 if self.firmest is None else self.firmest.z

    @property
    def firmest(self) -> Candidate | None:
        """The firmest bearing defect that stands."""
        standing = [c for c in self.every if c.family.kind in DEFECTS and c.present and c.risen and c.deep]
        return max(standing, key=lambda c: c.z, default=None)

    @property
    def heard_z(self) -> float:
        """Score of the firmest bearing family that is there, as deep in the baseline, else 0."""
        return max((c.z for c in self._old), default=0.0)

    def hears(self, other: Judged, factor: float) -> bool:
        """Whether such a family has the impacts that stand firmest at `factor` times the speed."""
        return other.firmest is not None and any(
            abs(c.best.order / (other.firmest.best.order * factor) - 1.0) < SAME_LINES for c in self._old
        )

    @property
    def _old(self) -> list[Candidate]:
        return [c for c in self.every if c.family.kind in DEFECTS and c.present and not c.risen and c.based]

    @property
    def part(self) -> str:
        """`the outer race of drive_end`, or `no part`."""
        c = self.firmest
        return "no part" if c is None else f"{PARTS[c.family.kind]} of {c.family.site}"


def speed_unread(stated: Judged, others: Sequence[tuple[Judged, float]], first: Observation) -> Report:
    """The report at the stated speed, held against those at other speeds (with that speed, Hz).

    It stands where they are other parts' and less firm, with the remark that the speed is not confirmed; else the
    verdict is ambiguous, or, where another speed explains what the stated one does not, that is said. A part that
    makes these impacts at the stated speed, or is as firm there, needs no other speed, though the baseline has it too.
    """
    shaft, speed = first.speed.shaft, first.speed.speed_hz
    as_well = [
        (one, hz)
        for one, hz in others
        if one.z > max(stated.z - ALIKE_Z, stated.heard_z, 0.0)
        and one.part != stated.part
        and not stated.hears(one, hz / speed)
    ]
    if not as_well:
        return _unconfirmed(stated, first)
    top = max(one.z for one, _ in as_well)
    told = sorted(((one, hz) for one, hz in as_well if one.z > top - BEHIND_Z), key=lambda r: -r[0].z)
    causes = at_either((stated, speed), *told)
    shown, at = max(((stated, speed), *told), key=lambda r: r[0].z)
    parts = ", ".join(f"at {hz:.4g} Hz of {one.part} ({one.z:.0f} deviations)" for one, hz in told)
    own = f" ({stated.z:.0f} deviations)" if stated.z > 0 else ""
    note = (
        f"whether {shaft} turns at {speed:.4g} Hz as stated: no line confirms it; the impacts are then those of "
        f"{stated.part}{own}, {parts}"
    )
    return replace(
        shown.report,
        verdict="ambiguous",
        sentence=f"The speed is not confirmed by any line, and the part hangs on it: at {speed:.4g} Hz as stated the "
        f"impacts are those of {stated.part}, {_listed(told)}; a tacho decides. At {at:.4g} Hz: "
        f"{shown.report.sentence}",
        where=placed(shown.report.where, causes),
        causes=causes,
        undecidable=(note, *shown.report.undecidable),
        next_experiment=TACHO,
    )


def _listed(told: Sequence[tuple[Judged, float]]) -> str:
    return " and ".join(f"at {hz:.4g} Hz of {one.part}" for one, hz in told)


def _unconfirmed(stated: Judged, first: Observation) -> Report:
    """The report with the remark, or with what comes once a turn where that tells the speed; where nothing is said at
    all, `reconcile.kinematics.remarks` has one."""
    report, shaft, speed_hz = stated.report, first.speed.shaft, first.speed.speed_hz
    if report.verdict in ("nothing_missing", "not_decidable"):
        return report
    turn = once_a_turn(stated.every, shaft) if stated.z > 0 else None  # its multiples fit half the speed too
    if turn is not None:
        limit = (
            f"no line of the spectrum confirms the stated speed of {shaft}, {speed_hz:.4g} Hz; what comes once a turn "
            f"in the envelope of {turn.best.channel} does, at {turn.best.order * speed_hz:.4g} Hz"
        )
        return replace(report, where=replace(report.where, limits=(*report.where.limits, limit)))
    note = f"whether {shaft} turns at {speed_hz:.4g} Hz as stated: no line confirms it"
    if stated.z > 0:
        note += f"; no speed that is {percent(SPAN, 0)} off explains the impacts as well by another part"
    return replace(report, undecidable=(*report.undecidable, note))


def once_a_turn(every: Sequence[Candidate], shaft: str) -> Candidate | None:
    """The family of a shaft's turn where it surely stands at the stated speed, not at the end of the search for it."""
    turns = [c for c in every if c.family.kind == "turn" and c.family.site == shaft]
    sure = [c for c in turns if c.z >= SURE_Z and c.chance < SURE_CHANCE and abs(c.best.order - 1.0) <= SURE_OFF]
    return max(sure, key=lambda c: c.z, default=None)


def placed(where: Where, causes: Sequence[Cause]) -> Where:
    """The place as all causes tell it, each by the score of its firmest: what is to be looked at follows them too."""
    firmest: dict[str, float] = {}
    for c in causes:
        firmest[c.site] = max(firmest.get(c.site, 0.0), c.score)
    total = sum(firmest.values())
    if total <= 0.0:
        return where
    ranked = sorted(firmest.items(), key=lambda one: -one[1])
    return replace(where, sites=tuple(PlaceWeight(site=site, weight=score / total) for site, score in ranked))


def at_either(*judged: tuple[Judged, float]) -> tuple[Cause, ...]:
    """Causes at all these speeds (Hz), none named: each says at which speed it holds."""
    found: dict[tuple[str, str], tuple[Cause, list[float]]] = {}
    for one, hz in judged:
        for c in one.report.causes if one.z > 0 else ():
            best, speeds = found.get((c.term, c.site), (c, []))
            found[c.term, c.site] = (max(best, c, key=lambda x: x.score), [*speeds, hz])
    causes = []
    for c, speeds in found.values():
        how = "at either speed, but with another rate" if len(speeds) > 1 else f"only if it turns at {speeds[0]:.4g} Hz"
        causes.append(replace(c, named=False, reasons=(*c.reasons, how)))
    return tuple(sorted(causes, key=lambda c: -c.score))
