"""A finished reconciliation on the server: its report, its page, the revised machine."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from sideband_client.errors import NotFound
from sideband_client.files import check_free, whole_file
from sideband_client.transport import Transport

REPORT, PAGE, MACHINE = "report.json", "report.html", "machine.json"


class Reconciliation:
    """What a successful reconciliation left on the server. Nothing is loaded before it is asked for."""

    def __init__(self, transport: Transport, reconciliation_id: str) -> None:
        self._transport, self.id = transport, reconciliation_id
        self._path = f"/v1/reconciliations/{reconciliation_id}"

    @cached_property
    def report(self) -> Mapping[str, Any]:
        """`verdict`, `sentence`, `where`, `causes`, `held_out`, `next_experiment` ... (docs/reconcile.md)."""
        return self._transport.json("GET", f"{self._path}/{REPORT}")

    @cached_property
    def machine(self) -> dict[str, Any] | None:
        """The revised machine, which `simulate` takes; None where there was none to revise."""
        try:
            return self._transport.json("GET", f"{self._path}/machine")
        except NotFound as refused:
            if refused.problem != "unknown-part":  # the reconciliation itself is not there
                raise
            return None

    def save(self, folder: str | Path, *, overwrite: bool = False) -> Path:
        """Write report.json, report.html (pictures inside) and, where there is one, machine.json, each whole or not at
        all; AlreadyThere when one exists."""
        target = Path(folder)
        wanted = {REPORT: REPORT, PAGE: PAGE} | ({} if self.machine is None else {MACHINE: "machine"})
        if not overwrite:
            check_free(*(target / name for name in wanted))
        target.mkdir(parents=True, exist_ok=True)
        for name, part in wanted.items():
            with self._transport.stream(f"{self._path}/{part}") as reply, whole_file(target / name) as stream:
                for piece in reply.iter_bytes():
                    stream.write(piece)
        return target
