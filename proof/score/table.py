"""The scores as text."""

from __future__ import annotations

from collections.abc import Sequence

from proof.score.one import Score
from proof.score.rates import at_target, group_rates, quantiles


def table(scores: Sequence[Score]) -> str:
    """Rates by group, for all cases and for those at the target condition; then every failure."""
    lines: list[str] = []
    for title, part in (("all cases", scores), ("target condition", [s for s in scores if at_target(s)])):
        lines.append(f"{title} (90 % intervals)")
        for group, row in group_rates(part).items():
            lines.append(f"  {group}")
            lines += [f"    {name:18s} {r.text()}" for name, r in row.items()]
        for name, values in (
            ("severity error", quantiles(s.severity_error for s in part)),
            ("held-out gain", quantiles(s.gain for s in part)),
        ):
            lines.append(f"  {name}: " + ", ".join(f"{key} {value:.3g}" for key, value in values.items()))
    lines.append("wrong:")
    lines += [f"  {line}" for line in failures(scores)]
    return "\n".join(lines) + "\n"


def wrong(s: Score) -> bool:
    """Whether anything about the answer that a user acts on is wrong."""
    return not s.verdict_right or False in (s.mechanism, s.place, s.both, s.fault_kind, s.fault_channel)


def failures(scores: Sequence[Score]) -> list[str]:
    """One line a case that is wrong in anything a user acts on."""
    names = ("verdict_right", "mechanism", "place", "both", "fault_kind", "fault_channel")
    found = []
    for s in filter(wrong, scores):
        missed = ", ".join(name for name in names if getattr(s, name) is False)
        where = f"level {s.level}, {s.sensors} sensors, {s.snr_db:g} dB, {s.speeds} speeds"
        said = {None: "", True: ", and that it need not show", False: ", though by its own table it shows"}[
            s.told_unseen
        ]
        found.append(f"{s.name} {s.group} {'+'.join(s.laws) or '-'} ({where}): said {s.verdict}{said}; wrong: {missed}")
    return found
