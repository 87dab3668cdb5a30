"""What a job that failed tells the person who asked."""

from __future__ import annotations

from jobs.run import failure_of
from sim.core.errors import Meaningless


def test_a_run_without_meaning_fails_with_its_reasons_and_advice():
    error = Meaningless(reasons=("108 % of the energy is unaccounted for",), advice="let the force rise more slowly")
    failure = failure_of(error, ())
    assert failure.code == "meaningless" and failure.advice == "let the force rise more slowly"
    assert failure.detail == {"reasons": ["108 % of the energy is unaccounted for"]}
    assert "108 %" in failure.message and "Traceback" not in failure.message
