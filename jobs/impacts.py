"""Impacts of a simulated machine: which contacts there are, which outputs they need, and the document of a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace

import numpy as np

from signals.impacts import Contact, ContactImpacts, find_impacts
from signals.recording import Recording, from_response
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.solve.transient import transient_end_s

FORCES = ("normal_force", "force")
"""Names of the force of a wall and of a mesh."""
STATE = "contact"


def contact_outputs(channels: tuple[str, ...]) -> tuple[str, ...]:
    """Outputs that impacts are read from: state and force of every contact that has both."""
    known = set(channels)
    pairs = [(name, _force_of(name, known)) for name in channels if name.endswith(f".{STATE}")]
    return tuple(name for state, force in pairs if force is not None for name in (state, force))


def impacts_document(response: Response, start_s: float) -> dict[str, object] | None:
    """`contacts` with their events and histograms; None where no contact was recorded."""
    recording = from_response(response).select(start_s=start_s)
    shafts = {base: hz for base, hz in response.bases_hz.items() if base.startswith("f_r")}
    found = [
        find_impacts(
            contact,
            sampling_rate_hz=recording.sampling_rate_hz,
            start_s=recording.start_s,
            shafts_hz=shafts,
        )
        for contact in _contacts(recording, response.machine, response.bases_hz)
    ]
    if not found:
        return None
    return {
        "from_s": recording.start_s,
        "sampling_rate_hz": recording.sampling_rate_hz,
        "angles": "degrees of each shaft from t = 0 at its mean speed",
        "phase": "share of the period from t = 0",
        "contacts": [_plain(contact) for contact in found],
    }


def impacts_summary(document: Mapping[str, object]) -> dict[str, object]:
    """The document without events and histograms."""
    contacts = document["contacts"]
    assert isinstance(contacts, list)
    kept = ("site", "counts", "contact_share", "largest_force_n", "rate_hz")
    return {
        c["contact"]: {
            **{k: c[k] for k in kept},
            "keeps_time_with": [f["base"] for f in c["folds"] if f["locked"]],
        }
        for c in contacts
    }


def narrowed(response: Response, channels: tuple[str, ...]) -> Response:
    """The response as if only `channels` had been asked for."""
    if channels == tuple(c.name for c in response.channels):
        return response
    rows = [next(i for i, c in enumerate(response.channels) if c.name == name) for name in channels]
    signals = np.ascontiguousarray(response.signals[rows])
    rate = response.sampling_rate_hz
    turning = [hz for base, hz in response.bases_hz.items() if base.startswith("f_r")]
    period_s = 1.0 / max(turning) if turning else signals.shape[1] / rate / 20.0
    settled = transient_end_s(signals, rate, period_s)
    return replace(
        response,
        channels=tuple(response.channels[i] for i in rows),
        signals=signals,
        quality=replace(response.quality, transient_end_s=settled),
    )


def _force_of(state: str, known: set[str]) -> str | None:
    element = state.removesuffix(f".{STATE}")
    return next((f"{element}.{name}" for name in FORCES if f"{element}.{name}" in known), None)


def _contacts(recording: Recording, machine: MachineSpec, bases_hz: Mapping[str, float]) -> list[Contact]:
    known = {c.name for c in recording.channels}
    sites = {c.name: c.location for c in recording.channels}
    found = []
    for state in (c.name for c in recording.channels if c.name.endswith(f".{STATE}")):
        force = _force_of(state, known)
        if force is not None:
            found.append(
                Contact(
                    name=state.removesuffix(f".{STATE}"),
                    site=sites[state],
                    touching=recording.series(state).samples,
                    force_n=recording.series(force).samples,
                    periods_hz=_periods(sites[state], machine, bases_hz),
                )
            )
    return found


def _periods(site: str, machine: MachineSpec, bases_hz: Mapping[str, float]) -> dict[str, float]:
    """Shafts and meshes, and the cage and the ball pass of the contact's own bearing."""
    own = [f"f_{x}{i}" for i, b in enumerate(machine.bearings, 1) if b.name == site for x in "co"]
    names = [base for base in bases_hz if base.startswith(("f_r", "f_m"))]
    return {base: bases_hz[base] for base in [*names, *own] if base in bases_hz}


def _plain(found: ContactImpacts) -> dict[str, object]:
    document = asdict(found)
    document["folds"] = [{**asdict(f), "locked": f.locked} for f in found.folds]
    return document
