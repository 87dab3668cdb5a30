"""What to do about a fault of the measurement, by its kind."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.verdict import SensorFault

AGAIN = "and record again before judging the machine"
ASKED = "and ask again; nothing needs to be recorded anew"
BEFORE = "before judging the machine"
MENDED = {
    "unit_mismatch": ("correct the unit, or the sensitivity, that is stated for {at}", ASKED),
    "swapped_channels": ("put the channels of the tests in their right order (here {at})", ASKED),
    "speed_mismatch": ("correct the speed that the description states, or give a tacho,", BEFORE),
    "other_motion": ("correct the quantity that is stated for {at}", ASKED),
    "out_of_step": ("record {at} and what drives it by one clock, through equal filters, or correct the delay,", ASKED),
    "polarity": ("turn one of both channels round", ASKED),
    "sampling_rate": ("correct the sampling rate that the description states", ASKED),
    "drift": ("check what {at} is fixed to, its supply and its warm-up", AGAIN),
    "gain_change": ("check range and sensitivity of {at}; if they are as before, inspect the parts beside it", ""),
    "repeated": ("check the recorder's buffer (here {at})", AGAIN),
    "copied": ("check which sensor each channel of the tests is of (here {at})", AGAIN),
    "filter_change": ("set the filter of {at} as it was", AGAIN),
    "clipped": ("set a larger range at {at}", AGAIN),
    "mains_hum": ("check earth and shield of {at}", AGAIN),
    "alias": ("filter {at} below half the sampling rate", AGAIN),
    "tacho_jitter": ("check the tacho", AGAIN),
    "irregular_time": ("check the recorder's clock", AGAIN),
    "fixed_tones": ("find what runs at these frequencies beside the machine, or record with it off,", BEFORE),
    "loose_sensor": (
        "check how the sensor of {at} is fastened; if it is tight, inspect what turns beside it: teeth, bearings, fits",
        "",
    ),
}
"""What to do, and what then where the fault is the whole answer."""
ALSO_ON = "; also on "
"""Before the further channels of a fault of one kind (`reconcile.gate.findings`)."""
USUAL = ("check sensor and cable of {at}", AGAIN)


def to_mend(fault: SensorFault, *, beside: bool = False, several: Sequence[SensorFault] = ()) -> str:
    """A clause with its full stop, which begins small; `beside` another answer what follows is not said. `several`:
    all faults; those that are mended alike share the clause, other sure ones follow it with their own."""
    what, then = _clause(fault)
    what = what.format(at=_channels(fault, several) or "all channels")
    said = f"{what.rstrip(',')}." if beside or not then else f"{what} {then}."
    others = [f for f in several if not f.doubtful and _clause(f) != _clause(fault)]
    firsts = {_clause(f): f for f in reversed(others)}
    more = [to_mend(f, beside=True, several=[o for o in others if _clause(o) == _clause(f)]) for f in firsts.values()]
    return " ".join([said, *(f"Also {text}" for text in reversed(more))])


def _clause(fault: SensorFault) -> tuple[str, str]:
    return MENDED.get(fault.kind, USUAL)


def channels(fault: SensorFault, several: Sequence[SensorFault] = ()) -> list[str]:
    """The channel, the others that the detail names, and those with the same fault."""
    if not fault.channel:
        return []
    told = fault.detail.partition(ALSO_ON)[2]
    alike = [f.channel for f in several if f.kind == fault.kind and f.channel]
    return list(dict.fromkeys([fault.channel, *(told.split(", ") if told else ()), *alike]))


def _channels(fault: SensorFault, several: Sequence[SensorFault]) -> str:
    """All that are mended alike: a silent channel and a stuck one are both looked at."""
    alike = [f for f in several if f.kind == fault.kind or (not f.doubtful and _clause(f) == _clause(fault))]
    every = [name for f in (fault, *alike) for name in channels(f, several)]
    *many, last = dict.fromkeys(every) or [""]
    return f"{', '.join(many)} and {last}" if many else last
