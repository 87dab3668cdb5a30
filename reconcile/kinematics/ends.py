"""Whether a named bearing's lines are loudest at its own sensor.

The name comes from the order, the place from the machine file: with a wrong type in the file, or the sensors of two
ends exchanged, the part that has this order stands at one end and is heard at the other. How loud is the absolute
strength of the family's lines in the squared envelope, less the baseline's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy import fft

from reconcile.gate import Gate
from reconcile.gate.spoiled import HEARD
from reconcile.kinematics.answer import TERMS
from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.contrast import single_band
from reconcile.kinematics.envelopes import STEPS, equal_angles, means_between, squared_envelope
from reconcile.kinematics.evidence import comb_depth
from reconcile.kinematics.families import Ties
from reconcile.kinematics.judge import same
from reconcile.kinematics.labels import UNTOLD
from reconcile.kinematics.lines import matched
from reconcile.kinematics.observe import Observation
from reconcile.report.action import LOUDEST, UNIT_OR_GAIN
from reconcile.verdict import Report
from signals.units import UNCALIBRATED

WIDEST = 3
"""Bands that are looked at: all, and both halves of it."""
LOUDER_DB = 4.0
"""More at another bearing's sensor than at its own from which a word is said. Of 43 pits in made motors that were named
right (31 with a baseline) the own sensor led by 2.8 to 14.3, so that 41 are told with the sensors exchanged and none as
they are; at a measured motor an outer race by 21, an inner race by 4.2 to 4.8."""
LEAST_SHARE = 1e-3
"""Of a strength, below which what came over the baseline's is not read."""
TINY = 1e-300


def with_ends(
    report: Report,
    gate: Gate,
    every: Sequence[Candidate],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    tie: Ties,
) -> Report:
    """The report, which says where a bearing that is named alone is heard louder at another one's sensor.

    Asked of channels of one quantity and known unit alone, and of no recordings whose measurement is surely at
    fault.
    """
    sites = {c.site for c in report.causes}
    told = report.verdict in ("explained", "ambiguous") and not report.sentence.startswith(UNTOLD)
    if not told or len(sites) != 1 or any(f.fault and f.kind not in HEARD for f in gate.findings):
        return report
    (site,) = sites
    candidate = _candidate(report, site, every, tie)
    bearings = {f.site for f in tie.families if f.kind in DEFECTS}
    channels = [c for c in tests[0].recording.channels if c.location in bearings]
    places = {c.name: c.location for c in channels}
    comparable = len({(c.quantity, c.unit) for c in channels}) == 1 and channels[0].unit != UNCALIBRATED
    if candidate is None or not comparable or {site} >= set(places.values()) or site not in places.values():
        return report
    level = strengths(candidate, tests, baselines)
    loudest = max(places, key=lambda name: level[name])
    more = level[loudest] - max(level[name] for name in places if places[name] == site)
    if more < LOUDER_DB:
        return report
    text = (
        f"its lines are {LOUDEST} {places[loudest]}, by {more:.0f} dB: the sensors may be exchanged, the "
        f"{UNIT_OR_GAIN} of one wrong, or the types of the bearings in the machine file"
    )
    limit = f"the lines of {site} are{text.removeprefix('its lines are')}"
    return replace(
        report,
        sentence=f"{report.sentence} But {text}.",
        where=replace(report.where, limits=(*report.where.limits, limit)),
    )


def _candidate(report: Report, site: str, every: Sequence[Candidate], tie: Ties) -> Candidate | None:
    """The firmest that the causes name; of equal bearings one stands for all."""
    terms = {c.term for c in report.causes}
    own = [f for f in tie.families if f.site == site and TERMS.get(f.kind) in terms]
    told = [c for c in every if any(c.family.kind == f.kind and same(c.family, f) for f in own)]
    return max(told, key=lambda c: c.z, default=None)


def strengths(candidate: Candidate, tests: Sequence[Observation], baselines: Sequence[Observation]) -> dict[str, float]:
    """dB by channel, the mean of the tests: what the candidate's lines came to in the squared envelope."""
    total: dict[str, list[float]] = {}
    for e, test in zip(candidate.evidence, tests, strict=True):
        base = matched(test, baselines)
        for name in test.recording.names:
            now = _strength(test, name, candidate, e.order)
            before = 0.0
            if base is not None and name in base.recording.names:
                before = _strength(base, name, candidate, e.order)
            came = max(now - before, LEAST_SHARE * now, TINY)
            total.setdefault(name, []).append(10.0 * float(np.log10(came)))
    return {name: float(np.mean(rows)) for name, rows in total.items()}


def _strength(one: Observation, channel: str, candidate: Candidate, order: float) -> float:
    """Largest over the bands of what the comb's lines are in the squared envelope, in its unit squared."""
    like = one.channel(channel)
    assert like is not None
    samples, rate = one.recording.series(channel).samples, one.recording.sampling_rate_hz
    transform = np.asarray(fft.rfft(samples - np.mean(samples)), dtype=np.complex128)
    per_turn = int(np.ceil(STEPS * like.order_step * like.excess.shape[1]))
    times = equal_angles(like.angle_rad, rate, per_turn)
    found = [0.0]
    for low, high in like.bands_hz[:WIDEST]:
        square, own_rate, _ = squared_envelope(transform, float(low), float(high), rate)
        single = single_band(means_between(square, own_rate, times), per_turn, like)
        scale = float(np.mean(square)) * (own_rate / rate) ** 2
        found.append(scale * comb_depth(single, 0, candidate.family, order))
    return max(found)
