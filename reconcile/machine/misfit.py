"""Does the machine file describe the machine of the baseline at all? Else nothing that its machines show is a measure.

Machines of the kind are moved until their own lines (of teeth, if there are any) agree with the baseline, each number
within what the file allows. Where they cannot, the sound machines that changes are measured by are other machines.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

from reconcile.verdict import NextExperiment, Report
from sim.core.spec import MachineSpec

FOREIGN = 7.0
"""Mean squared residual of the fitted machines' mesh lines over their errors' variance (1 where both agree) from which
the file is not this machine's: 0.9 to 5.0 on the proof's 50 cases of `next`, `others` and `unmet`, whose generator has
laws of its own and hidden numbers within a tenth of the file's; 9.4 with the rotors' masses three times too large."""
FOREIGN_BARE = 2.0
"""The same without teeth, where the errors hold what lines do not repeat: 0.35 to 1.23 on 28 concealed rotors; 2.7 with
supports a third as stiff, 7.1 with three times the mass."""
UNKNOWABLE = "whether an effect is missing or the machine file's numbers are wrong"
HARDLY_DB = 40.0
"""From so much above the fitted machines on a line is one that the file makes none of."""
TURNING = ("unbalance", "bent_shaft")
RESIDUAL = (
    "The file gives no rotor a residual unbalance, and every rotor has one (ISO 21940-11 grades it): add it as a term "
    "`unbalance`."
)


def with_misfit(report: Report, fit: Mapping[str, object], machine: MachineSpec) -> Report:
    """The report with what its machines cannot be fitted to, if they cannot; unknown physics is then not decidable.

    `fit`: how well machines agree with the baseline, empty where there is none.
    """
    off = cast(float, fit.get("misfit_after", 0.0))
    if off < cast(float, fit.get("misfit_allowed", FOREIGN)):
        return report
    told, advice = _told(off, fit), _advice(fit, machine)
    # what would have been seen is measured with the file's machines
    limited = replace(report, where=replace(report.where, limits=(*report.where.limits, told)), faintest=())
    if report.verdict == "measurement_fault":
        return limited
    if report.verdict != "unknown_physics":
        told = f"{told}. {RESIDUAL}" if _unbalanced(fit, machine) else f"{told}."
        return replace(limited, sentence=f"{report.sentence} But {told}")
    return replace(
        limited,
        verdict="not_decidable",
        sentence=f"No known effect explains what differs, but {told}: what its sound machines show is no measure of "
        "this one.",
        where=replace(limited.where, sites=()),
        force=None,
        machine=None,
        undecidable=(UNKNOWABLE, *report.undecidable),
        next_experiment=NextExperiment(sentence=advice),
    )


def _advice(fit: Mapping[str, object], machine: MachineSpec) -> str:
    teeth = " teeth," if machine.gears else ""
    check = f"Check the machine file against the machine (masses, stiffnesses,{teeth} supports), and that the baseline "
    check += "is of this machine."
    return f"{RESIDUAL} {check}" if _unbalanced(fit, machine) else check


def _unbalanced(fit: Mapping[str, object], machine: MachineSpec) -> bool:
    """Whether the line that is farthest off is a turn of a shaft, which a file without any unbalance hardly makes."""
    farthest = cast(Sequence[Mapping[str, object]], fit.get("farthest", ()))
    if not farthest or any(term.term in TURNING for term in machine.terms):
        return False
    return str(farthest[0]["line"]).startswith("1*f_r") and cast(float, farthest[0]["off_db"]) > HARDLY_DB


def _told(off: float, fit: Mapping[str, object]) -> str:
    farthest = cast(Sequence[Mapping[str, object]], fit.get("farthest", ()))
    lines = "; ".join(_line(one) for one in farthest[:1])
    strayed = cast(Sequence[str], fit.get("strayed", ()))
    numbers = "number" if len(strayed) == 1 else "numbers"
    named = strayed[0] if len(strayed) == 1 else f"{strayed[0]} and others" if strayed else ""
    edge = f", {len(strayed)} {numbers} at the edge of their spread ({named})" if strayed else ""
    worst = f" (farthest: {lines})" if lines else ""
    return (
        "the machine file does not fit the baseline: with all of its numbers moved within their spread its own lines "
        f"are still off by {off**0.5:.1f} times their error{worst}{edge}"
    )


def _line(one: Mapping[str, object]) -> str:
    off = cast(float, one["off_db"])
    side = "above" if off > 0.0 else "below"
    least = "of which the file makes hardly any" if off > HARDLY_DB else f"{abs(off):.0f} dB {side} the file's machines"
    return f"{one['line']} at {one['speed_hz']:g} Hz in {one['channel']}, {least}"
