"""Pictures of a prescribed motion: force over time on the held-out run, over displacement, and as a map."""

from __future__ import annotations

import numpy as np

from reconcile.driven.nominate import score_nats
from reconcile.driven.prescribed.analysis import Findings
from reconcile.force_law.picture import curve, surface
from reconcile.force_law.samples import ForceSamples, even_blocks

SHOWN_CYCLES_S = 3.0
"""Length of the stretch shown and of the input that the revised machine carries."""
BLOCKS = 12


def _samples(found: Findings, *, rising: bool | None = None) -> ForceSamples:
    """Force of the fitted run after its start; with `rising` only one direction of the motion."""
    run = found.fitted
    kept = np.arange(run.skip, run.force.size)
    if rising is not None:
        kept = kept[(run.motion.velocity[kept] > 0) == rising]
    return ForceSamples(
        force_n=run.force[kept],
        displacement_m=run.motion.displacement[kept],
        velocity_m_per_s=run.motion.velocity[kept],
        blocks=even_blocks(kept.size, BLOCKS),
        step_s=run.motion.step_s,
    )


def force_samples(found: Findings) -> dict[str, tuple[float, ...]]:
    """Measured force over displacement with a band, rising branch then falling."""
    rng = np.random.default_rng(0)
    parts = []
    for rising in (True, False):
        samples = _samples(found, rising=rising)
        parts.append(curve(samples, samples.displacement_m, rng, bins=30))

    def joined(name: str) -> tuple[float, ...]:
        return tuple(float(x) for p in parts for x in getattr(p, name))

    keys = {"displacement_m": "argument", "force_n": "force_n", "low_n": "low_n", "high_n": "high_n"}
    return {key: joined(name) for key, name in keys.items()}


def _law(found: Findings, *, rising: bool, named: bool) -> dict[str, object]:
    rng = np.random.default_rng(0)
    samples = _samples(found, rising=rising)
    over = curve(samples, samples.displacement_m, rng, bins=30)
    run = found.fitted
    kept = np.arange(run.skip, run.force.size)
    kept = kept[(run.motion.velocity[kept] > 0) == rising]
    modelled = ForceSamples(
        force_n=found.chosen.on(run.motion)[kept], displacement_m=samples.displacement_m,
        velocity_m_per_s=samples.velocity_m_per_s, blocks=samples.blocks, step_s=samples.step_s,
    )  # fmt: skip
    fitted = curve(modelled, modelled.displacement_m, rng, bins=30).force_n
    side = "rising" if rising else "falling"
    return {
        "x_label": f"displacement ({side}), m", "y_label": "force, N", "x": over.argument, "force": over.force_n,
        "low": over.low_n, "high": over.high_n, "fitted": fitted, "named": named,
    }  # fmt: skip


def pictures(found: Findings, *, named: bool) -> dict[str, object]:
    """All pictures; `named`: whether the first law is the answer, not only the nearest."""
    held = found.held
    n = min(int(SHOWN_CYCLES_S / held.motion.step_s), held.force.size)
    rows = []
    for k, (trial, squares) in enumerate(found.trials):
        score, error = score_nats(found.linear_squares, squares)
        ends = {"low": score - 1.645 * error, "high": score + 1.645 * error}
        rows.append({"label": trial.structure.words, "score": score, "named": named and k == 0, **ends})
    plane = surface(_samples(found))
    time = np.arange(n) * held.motion.step_s
    return {
        "traces": [
            {
                "title": f"Force on {held.name}, held out", "unit": "N", "time_s": time,
                "observed": held.force[:n], "before": found.outcomes[0].before[:n],
                "after": found.outcomes[0].used.on(held.motion)[:n],
            }
        ],
        "ranking": rows,
        "law": [_law(found, rising=up, named=named) for up in (True, False)],
        "force_map": {
            "x_label": "displacement, m", "y_label": "velocity, m/s", "value_label": "N", "x": plane.displacement_m,
            "y": plane.velocity_m_per_s, "value": plane.force_n,
        },
    }  # fmt: skip
