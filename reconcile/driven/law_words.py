"""The laws of a driven analysis, in words."""

from __future__ import annotations

from reconcile.driven.aside import aside, beside_rest
from reconcile.driven.forced import Analysis
from reconcile.force_law.library import GAPPED, Law

MIDDLE = 0.05
"""Distance of the middle of stops from the channel's zero, over their gap, that is worth a word."""


def law_words(found: Analysis) -> str:
    """`odd stiffness, about cubic: exponent 2.96 (90 %: 2.94 to 2.97)`."""
    laws = found.final.model.laws
    said = " with ".join(f"{law.words} ({law.shown()})" for law in laws)
    if found.power is not None:
        p = found.power
        said += f"; the exponent of the odd part left free is {p.value:.2f} (90 %: {p.low:.2f} to {p.high:.2f})"
    seen = aside(found)
    return said + _aside(found) + ("" if seen is None else beside_rest(found, seen))


def product(coefficient: float, law: Law) -> str:
    """`4.02e+10 N/m^3 · z³`; the sign of a law that begins with one counts with the number's: `-2.7e+05 N/m · (…)₊`."""
    shown = law.shown()
    turned = -coefficient if shown.startswith("−") else coefficient
    return f"{turned:.4g} {law.unit} · {shown.removeprefix('−')}"


def _aside(found: Analysis) -> str:
    """Where stops stand, counted from the channel's zero, if their middle is not there."""
    model, data = found.final.model, found.held_run.data
    gaps = [law.shape for law in model.laws if law.key == "stops"]
    if data.order or not gaps or abs(model.output_offset) < MIDDLE * gaps[0]:
        return ""
    ends, unit = (model.output_offset + gaps[0], model.output_offset - gaps[0]), data.answer_channel.unit
    return f", of the channel's zero at {ends[0]:.3g} and {ends[1]:.3g} {unit}"


def from_rest(found: Analysis) -> tuple[str, ...]:
    """What a derivative of the motion does not tell of a gap."""
    laws = found.final.model.laws
    if not found.held_run.data.order or not any(law.key in GAPPED for law in laws):
        return ()
    return ("A gap is counted from where the mass rests: only its displacement would tell a constant force beside it.",)
