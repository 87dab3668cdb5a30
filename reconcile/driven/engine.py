"""The entry of the level `driven`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from reconcile.driven.answer import answer
from reconcile.driven.channels import Driven, driven_of
from reconcile.driven.direction import directed
from reconcile.driven.forced import analyse
from reconcile.driven.machine import driven_site
from reconcile.driven.prescribed.answer import reconcile_prescribed
from reconcile.driven.split import parts_of
from reconcile.origin import origin
from reconcile.told import about, place
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec

LEAST_SAMPLES = 3000
"""Of one recording: three parts, each with a fit and blocks of its own."""


def _checked(spec: MachineSpec, recordings: Sequence[Recording]) -> list[Driven]:
    if not recordings:
        raise SpecError(
            Problem(field="recordings", message="there is nothing to compare", given=0, allowed="1 or more")
        )
    with about(recordings[0].label):
        first = directed(recordings[0], spec)
    rest = [_further(r, spec, first.prescribed) for r in recordings[1:]]
    found = [first, *rest]
    for i, (one, data) in enumerate(zip(recordings, found, strict=True)):
        least = LEAST_SAMPLES if len(found) == 1 else LEAST_SAMPLES // 3
        if data.answer.size < least:
            message = "is too short for fitting and holding out"
            raise SpecError(
                Problem(
                    field=place(one, "recording", i, "samples"),
                    message=message,
                    given=data.answer.size,
                    allowed=f"{least} samples",
                )
            )
        for name, values in (("input", data.drive), ("output", data.answer)):
            if values.std() == 0.0:
                channel = data.drive_channel if name == "input" else data.answer_channel
                message = f"the {name} does not move"
                raise SpecError(
                    Problem(field=place(one, "recording", i, channel.name), message=message, given=float(values[0]))
                )
        if abs(data.step_s / found[0].step_s - 1.0) > 1e-6:
            message = "sampling rates of the recordings differ"
            where, allowed = place(one, "recording", i, "sampling_rate_hz"), f"{1.0 / found[0].step_s:g}"
            raise SpecError(Problem(field=where, message=message, given=1.0 / data.step_s, allowed=allowed, unit="Hz"))
    return found


def _further(recording: Recording, spec: MachineSpec, motion_drives: bool) -> Driven:
    with about(recording.label):
        return driven_of(recording, spec, motion_drives=motion_drives)


def reconcile_driven(
    spec: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording] = (), *, seed: int = 0
) -> Report:
    """Reconcile an oscillator with recordings of its input and output.

    A lone recording is cut into consecutive thirds; of several, the one that goes farthest is held out. Baselines are
    not needed (the linear model is calibrated on the recordings themselves) and only counted.
    """
    started = time.process_time()
    driven_site(spec)
    data = _checked(spec, tests)
    provenance: dict[str, object] = {
        "recordings": len(tests),
        "baselines_not_used": len(baselines),
    }
    if data[0].prescribed:
        report = reconcile_prescribed(spec, parts_of(data), seed=seed, provenance=provenance, assumed=data[0].assumed)
    else:
        report = answer(spec, analyse(parts_of(data), seed), seed=seed, provenance=provenance)
    return replace(report, provenance={**origin(seed, time.process_time() - started), **report.provenance})
