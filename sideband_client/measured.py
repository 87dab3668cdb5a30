"""Measured data: recordings sent in, machines followed over them, recordings reconciled with a model."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, Literal

from sideband_client.asking import PAGE, Asking, segment
from sideband_client.job import Job
from sideband_client.reconciliation import Reconciliation
from sideband_client.state import state_of
from sideband_client.transport import Form


class Measured(Asking):
    """The part of the client that is about recordings."""

    def send_recording(self, description: str | Path | Mapping[str, Any], data: str | Path | None = None) -> Job:
        """Send in a recording: its description (R.json, or its content) and the data file.

        `data` is needed with a mapping; beside R.json it is the file that R.json names, or the one of the same stem.
        The same content is kept once, under one id. `job.wait()` returns when it was read, and raises JobFailed (code
        `refused`, `detail` with the fields) when it is none; `recording(job.id)` then says what is in it.
        """
        if isinstance(description, Mapping):
            document: Any = dict(description)
        else:
            document = json.loads(Path(description).read_text(encoding="utf-8"))
            data = data or _beside(Path(description), document)
        if data is None:
            raise ValueError("data is needed: the file that the description is of")
        path = Path(data)
        with path.open("rb") as stream:
            form = Form(fields={"description": json.dumps(document)}, files={"file": (path.name, stream)})
            sent = self._transport.json("POST", "/v1/recordings", form=form)
        return Job(self._transport, state_of(self._transport.json("GET", f"/v1/jobs/{segment(str(sent['id']))}")))

    def recording(self, recording_id: str) -> dict[str, Any]:
        """How a recording stands: `status` (`ready`, `refused` ...), `report` with levels and findings, `condition`."""
        return self._transport.json("GET", f"/v1/recordings/{segment(recording_id)}")

    def recordings(self, *, machine: str | None = None, sort: str = "-created_at") -> Iterator[dict[str, Any]]:
        """Recordings that were sent in, the newest first; of one machine where its name is given."""
        return self.listed("/v1/recordings", "recordings", {"machine": machine, "sort": sort})

    def reconcile(
        self,
        machine: str | Mapping[str, Any],
        recordings: Sequence[str | Job],
        *,
        baselines: Sequence[str | Job] = (),
        budget: Literal["quick", "full"] = "quick",
        seed: int = 0,
        idempotency_key: str | None = None,
    ) -> Job:
        """Ask what recordings say that the machine's model leaves out (docs/reconcile.md).

        `machine`: a preset's name, a specification, or `{"kinematics": {...}}`. `recordings` and `baselines` (when it
        was sound): jobs of `send_recording` or ids, read already. `job.wait().reconciliation()` is the answer.
        Raises as `simulate`, and NotReady for a recording that is still being read.
        """
        body: dict[str, Any] = {"machine": machine if isinstance(machine, str) else dict(machine), "seed": seed}
        body |= {"recordings": _ids(recordings), "baselines": _ids(baselines), "budget": budget}
        return self.submitted("/v1/reconciliations", body, idempotency_key)

    def reconciliation(self, reconciliation_id: str) -> Reconciliation:
        """A finished reconciliation by its id."""
        return Reconciliation(self._transport, segment(reconciliation_id))

    def machines(self) -> Iterator[dict[str, Any]]:
        """The machines that recordings name: `name`, `recordings`, `last_seen`, `state`, `worst`, by name."""
        return self.listed("/v1/machines", "machines", {})

    def machine_health(
        self,
        name: str,
        *,
        start: datetime | str | None = None,
        end: datetime | str | None = None,
        channels: Sequence[str] | None = None,
        features: Sequence[str] | None = None,
        limit: int = PAGE,
    ) -> dict[str, Any]:
        """A machine over time: `points` (recordings), `series` of features with limits, `alarms`, `verdicts`.

        The latest `limit` recordings (500 at most) from `start` to `end` (with an offset from UTC); `end` at the first
        point's time asks for those before. Raises NotFound for an unknown machine or channel.
        """
        query = {"from": _moment(start), "to": _moment(end), "channel": channels, "feature": features, "limit": limit}
        return self._transport.json("GET", f"/v1/machines/{segment(name)}/health", query=query)


def _moment(time: datetime | str | None) -> str | None:
    return time.isoformat() if isinstance(time, datetime) else time


def _ids(given: Sequence[str | Job]) -> list[str]:
    return [one if isinstance(one, str) else one.id for one in given]


def _beside(path: Path, document: object) -> Path:
    """The data file of a description on disk."""
    named = document.get("data") if isinstance(document, Mapping) else None
    if isinstance(named, str):
        return path.parent / named
    found = [f for f in path.parent.iterdir() if f.name.startswith(f"{path.stem}.") and f.suffix != ".json"]
    if len(found) != 1:
        told = ", ".join(sorted(f.name for f in found)) or "none"
        raise ValueError(f"{path.name} needs one data file of its stem beside it, or data=; found: {told}")
    return found[0]
