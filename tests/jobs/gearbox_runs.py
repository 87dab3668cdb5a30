"""The paper's gearbox with chosen effects, carried out once with causes, for the tests of causes and impacts."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import pytest

from jobs.analysis import analyse
from jobs.carry_out import carry_out, completed
from jobs.documents import ResultDocuments
from jobs.physics import PhysicsEngine
from jobs.request import SimulationRequest
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset

SHARED = pytest.mark.xdist_group("gearbox-clearance")
"""Of tests that look at the run with clearance: seconds of a core, made once for all that are in one process."""
ENGINE = PhysicsEngine()
SENSORS = [f"resonator{i}.y.acceleration" for i in (1, 2)]
RUNOUT = TermSpec(term="eccentricity", site="pinion", parameters={"radius": 2e-5})
CLEARANCE = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 2e-5})
SERIES = TermSpec(term="fit_clearance_series", site="bearing1", parameters={"gap": 2e-5})
NOTHING = TermSpec(term="eccentricity", site="gear", parameters={"radius": 0.0})


def machine(*terms: TermSpec, base: str = "paper-lightly-damped") -> MachineSpec:
    return preset(base).model_copy(update={"terms": list(terms)})


def ask(spec: MachineSpec, **more: object) -> SimulationRequest:
    body = {"machine": spec, "duration_s": 1.0, "sampling_rate_hz": 20_000.0, "causes": True}
    body |= {"channels": SENSORS if "resonator1" in str(spec.resonators) else None} | more
    return SimulationRequest.model_validate(body)


@cache
def done(key: str, base: str) -> tuple[Response, ResultDocuments]:
    known = {"runout": RUNOUT, "clearance": CLEARANCE, "nothing": NOTHING, "series": SERIES}
    spec = machine(*(known[name] for name in key.split()), base=base)
    told: list[float] = []
    outcome = carry_out(ENGINE, spec, ask(spec), progress=told.append, cancelled=lambda: False)
    assert told == sorted(told) and told[-1] == 1.0, "progress goes through all runs"
    documents = completed(analyse(outcome.response, discard_transient=True), outcome.extras)
    return outcome.response, documents


def peaks(key: str, base: str = "paper-lightly-damped") -> dict[str, Mapping[str, Any]]:
    _, documents = done(key, base)
    listed = documents.peaks["peaks"]
    assert isinstance(listed, list)
    return {p["label"]: p for p in listed if p["label"]}


def share(peak: Mapping[str, Any], term: str, site: str) -> float:
    return sum(c["share"] for c in peak["causes"] if (c["term"], c["site"]) == (term, site))
