"""Faults of the samples themselves: not finite, silent, stuck, dropped out, clipped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.gate.bridge import FILLED, MOST_SAMPLES, bridged, holes
from reconcile.gate.findings import Finding, Kind
from reconcile.shares import percent
from signals.checks import Finding as Defect
from signals.checks import inspect
from signals.recording import Recording
from signals.series import BoolArray, FloatArray

KIND: dict[str, Kind] = {
    "not_finite": "not_finite",
    "constant": "silence",
    "stuck": "stuck",
    "dropout": "dropouts",
    "clipping": "clipped",
}
MATERIAL_SHARE = 2e-4
"""Clipped or held samples below this share change no spectrum by a tenth of a decibel."""
REPAIRABLE_SHARE = 0.02
QUIET_WINDOW_S = 2e-3
QUIET_RATIO = 0.02
"""A window whose RMS is below 2 % of the median window's: the signal was away, not weak."""
QUIET_TAIL = 2.5
"""Times that size: what is away leaves few windows between; a bearing that rattles is silent by degrees."""
SHARP_RUN, SHARP_RATIO = 3, 0.3
FREE_FALL_M_PER_S2, FREE_FALL_SHARE = 9.80665, 0.05
"""A ring in free flight is accelerated by its weight alone: a plateau there is no end of a range."""
PILE = 4.0
"""Clipping behind which noise or a filter follows: the outermost hundredth of the range holds this many times more
samples than the hundredth beside it; the tails of a moving signal thin out towards the ends."""
PILE_SAMPLES = 30


def sample_findings(recording: Recording, label: str) -> tuple[Finding, ...]:
    """Defects of every channel as findings; `fault` where they are large enough to matter."""
    n = recording.samples.shape[1]
    rows = dict(zip(recording.names, recording.samples, strict=True))
    found = [_of_defect(d, label, n, rows[d.channel]) for d in inspect(recording)]
    known = {(f.channel, f.kind) for f in found}
    for name, measured in rows.items():
        gone = ~np.isfinite(measured)
        samples = bridged(measured, gone) if _short(gone) else measured
        if not np.all(np.isfinite(samples)) or np.ptp(samples) == 0:
            continue
        if (name, "dropouts") not in known and (name, "stuck") not in known:
            found += _absences(samples, recording, name, label)
        if (name, "clipped") not in known:
            found += _piles(samples, name, label, recording.channels[recording.names.index(name)].unit)
    return tuple(found)


def repaired(recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    """(recording without hopeless channels and with short gaps bridged, names of the channels left out)."""
    rows, lost = [], []
    samples = recording.samples.copy()
    for row, name in enumerate(recording.names):
        bad = ~np.isfinite(samples[row])
        good = samples[row][~bad]
        if good.size < 8 or np.ptp(good) == 0 or np.mean(bad) > REPAIRABLE_SHARE:
            lost.append(name)
            continue
        samples[row] = bridged(samples[row], bad)
        rows.append(row)
    if not rows:
        return recording, tuple(lost)
    kept = tuple(recording.channels[r] for r in rows)
    return replace(recording, channels=kept, samples=samples[rows]), tuple(lost)


def _short(gone: BoolArray) -> bool:
    """Whether the samples `gone` (n,) are holes so short and few (`MATERIAL_SHARE`, one at least) that they may be
    bridged and the channel stays."""
    few = np.sum(gone) <= min(max(1.0, MATERIAL_SHARE * gone.size), gone.size - 1)
    return bool(few and all(stop - first <= MOST_SAMPLES for first, stop in holes(gone)))


def _of_defect(defect: Defect, label: str, n: int, samples: FloatArray) -> Finding:
    """A constant channel is silent at zero and stuck anywhere else; of `samples` (n,), its channel's."""
    share = defect.samples / n
    first = defect.places[0]
    several = "one stretch," if defect.count == 1 else f"{defect.count} stretches, the first at"
    where = f"{several} {first.start_s:.6g} to {first.stop_s:.6g} s"
    kind = KIND[defect.kind]
    finite = np.isfinite(samples)
    if defect.kind == "constant" and samples[finite][0] != 0.0:
        kind = "stuck"
    always = defect.kind in ("not_finite", "constant", "dropout")
    detail = f"{defect.message}: {_share(share)} of the samples"
    mended = defect.kind == "not_finite" and _short(~finite)
    if mended:
        number = "1 sample is" if defect.samples == 1 else f"{defect.samples} samples are"
        detail = f"{number} not finite, the first at {first.start_s:.6g} s; {FILLED}"
    return Finding(
        kind=kind,
        channel=defect.channel,
        recording=label,
        detail=detail,
        severity=float(min(1.0, share * (1 if defect.kind == "constant" else 20))),
        where=where,
        fault=not mended and (always or share > MATERIAL_SHARE),
    )


def _share(share: float) -> str:
    """`100 %`, `0.034 %`: three figures."""
    return f"{np.format_float_positional(100 * share, precision=3, fractional=False, trim='-')} %"


def away(samples: FloatArray, sampling_rate_hz: float) -> BoolArray:
    """Samples (n,) of stretches in which the signal is all but gone though not exactly constant, shape (n,)."""
    quiet, length = _quiet_blocks(samples, sampling_rate_hz)
    mask = np.zeros(samples.size, dtype=np.bool_)
    mask[: quiet.size * length] = np.repeat(quiet, length)
    return mask


def _quiet_blocks(samples: FloatArray, sampling_rate_hz: float) -> tuple[BoolArray, int]:
    """(whether each block is quiet, none where most are, samples a block)."""
    length = max(16, int(QUIET_WINDOW_S * sampling_rate_hz))
    count = samples.size // length
    if count < 20:
        return np.zeros(0, dtype=np.bool_), length
    samples = np.where(np.isfinite(samples), samples, np.nan)
    blocks = samples[: count * length].reshape(count, length)
    size = np.std(blocks, axis=1)
    usual = float(np.median(size))
    least = QUIET_RATIO * usual
    quiet: BoolArray = np.asarray(size < least, dtype=np.bool_)
    if np.sum((size >= least) & (size < QUIET_TAIL * least)) >= np.sum(quiet):
        quiet = _sharp(size < QUIET_TAIL * least, size > SHARP_RATIO * usual)
    # a slow strong line has quiet windows around its extremes: the level must be away from the extremes as well
    quiet &= np.abs(np.mean(blocks, axis=1) - np.mean(samples)) < 0.5 * np.std(samples)
    return (quiet if np.mean(quiet) <= 0.5 else np.zeros_like(quiet)), length


def _sharp(low: BoolArray, loud: BoolArray) -> BoolArray:
    """Of runs of `low` windows (n,) those of `SHARP_RUN` or more between `loud` ones, one window of their edges apart:
    a dropout begins and ends within a window, a rattle fades into its silence."""
    found = np.zeros_like(low)
    steps = np.flatnonzero(np.diff(np.concatenate([[False], low, [False]]).astype(np.int8)))
    for first, last in zip(steps[::2], steps[1::2], strict=True):
        before, after = loud[max(0, first - 2) : first], loud[last : last + 2]
        if last - first >= SHARP_RUN and before.any() and after.any():
            found[first:last] = True
    return found


def _absences(samples: FloatArray, recording: Recording, name: str, label: str) -> list[Finding]:
    """Stretches in which the signal is all but gone though not exactly constant (converter noise remains)."""
    quiet, length = _quiet_blocks(samples, recording.sampling_rate_hz)
    if not np.any(quiet):
        return []
    start = float(np.flatnonzero(quiet)[0] * length / recording.sampling_rate_hz + recording.start_s)
    share = float(np.mean(quiet))
    detail = f"the signal is away for {percent(share, 2)} of the time"
    where = f"first at {start:.6g} s"
    return [
        Finding(
            kind="dropouts",
            channel=name,
            recording=label,
            detail=detail,
            severity=min(1.0, 5 * share),
            where=where,
            fault=True,
        )
    ]


def _piles(samples: FloatArray, name: str, label: str, unit: str) -> list[Finding]:
    """Samples piled up at an end of the range."""
    ends = {"upper": float(np.max(samples)), "lower": float(np.min(samples))}
    step = (ends["upper"] - ends["lower"]) / 100
    piled = {end: share for end, at in ends.items() if (share := _piled(np.abs(samples - at), step)) > 0.0}
    if len(piled) == 1 and unit == "m/s^2":  # a plateau at one end may be a flight
        fall = abs(abs(ends[next(iter(piled))]) / FREE_FALL_M_PER_S2 - 1.0)
        piled = {} if fall < FREE_FALL_SHARE else piled
    for end, share in piled.items():
        return [
            Finding(
                kind="clipped",
                channel=name,
                recording=label,
                detail=f"{_share(share)} of the samples are piled up at the {end} end of the range",
                severity=min(1.0, 20 * share),
                fault=True,
            )
        ]
    return []


def _piled(depth: FloatArray, step: float) -> float:
    """Share of the samples piled up at an end of the range, from which they are `depth` (n,) away; 0 for no pile."""
    outer = int(np.sum(depth < step))
    beside = int(np.sum((depth >= step) & (depth < 3 * step))) / 2
    # a sine has a pile too, but of a known height: 1/(pi sqrt(x(1-x))) gives 2.6 for these widths
    many = outer >= max(PILE_SAMPLES, MATERIAL_SHARE * depth.size)
    return outer / depth.size if many and outer > PILE * max(beside, 1.0) else 0.0
