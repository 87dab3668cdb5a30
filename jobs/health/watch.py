"""Machines as they were last judged, kept until one of their recordings comes or goes."""

from __future__ import annotations

from collections import OrderedDict
from threading import Lock

from jobs.health.machines import Watched, machine_names, watched
from jobs.health.points import records_of
from jobs.kept import Kept
from jobs.ports import ArtefactStore, JobCatalogue
from sim.core.errors import UnknownName

MOST_POINTS = 20_000
"""Over all machines that are kept."""


class Watch:
    """The machines last asked for. A judgement rests on a machine's recordings alone, and those never change."""

    def __init__(self) -> None:
        self._features = Kept()
        self._judged: OrderedDict[str, tuple[tuple[str, ...], Watched]] = OrderedDict()
        self._lock = Lock()

    def machine(self, catalogue: JobCatalogue, artefacts: ArtefactStore, name: str) -> Watched:
        """One machine; UnknownName when no recording names it."""
        records = records_of(catalogue, name)
        if not records and name not in (names := machine_names(catalogue)):
            raise UnknownName("machine", name, names)
        marks = tuple(record.id + (record.result.sha256 if record.result else "") for record in records)
        with self._lock:
            known = self._judged.get(name)
            if known is not None and known[0] == marks:
                self._judged.move_to_end(name)
                return known[1]
        found = watched(records, artefacts, self._features, name)
        with self._lock:
            self._judged[name] = (marks, found)
            self._judged.move_to_end(name)
            while len(self._judged) > 1 and sum(len(m) for m, _ in self._judged.values()) > MOST_POINTS:
                self._judged.popitem(last=False)
        return found
