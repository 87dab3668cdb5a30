"""The thread that keeps the promise: one pass of recovery every few seconds while the API lives."""

from __future__ import annotations

import logging
import threading

from app.state import AppState
from jobs import recover
from sim.core.errors import SidebandError

log = logging.getLogger(__name__)


class RecoveryThread:
    """Runs `jobs.recover.tick` until stopped; an error of one pass does not end it."""

    def __init__(self, state: AppState) -> None:
        self._state = state
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="recovery", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End and wait for the pass under way."""
        self._stopped.set()
        self._thread.join(10)

    def _run(self) -> None:
        while not self._stopped.is_set():
            try:
                recover.tick(self._state.desk(), max_losses=self._state.settings.max_losses)
            except SidebandError as error:
                log.warning("recovery put off: %s", error)
            except Exception:
                log.exception("recovery failed; it is tried again")
            self._stopped.wait(self._state.settings.recover_every_s)
