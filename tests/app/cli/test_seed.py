"""A seed has the same bounds on the command line as over HTTP."""

from __future__ import annotations

import argparse

import pytest

from app.cli.main import main
from app.cli.seed import seed
from jobs.reconciliations.request import ReconciliationRequest
from jobs.request import MOST_SEED, SimulationRequest


@pytest.mark.parametrize("text", ["-1", "1.5", "", "x", "²", str(MOST_SEED + 1), "7" * 40, "7" * 5000])
def test_what_is_no_seed_is_refused_with_what_is_allowed(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError) as refused:
        seed(text)
    assert f"from 0 to {MOST_SEED}" in str(refused.value) and len(str(refused.value)) < 150


def test_the_bound_is_that_of_requests() -> None:
    assert (seed("0"), seed(str(MOST_SEED))) == (0, MOST_SEED)
    for request in (SimulationRequest, ReconciliationRequest):
        bounds = request.model_json_schema()["properties"]["seed"]
        assert (bounds["minimum"], bounds["maximum"]) == (0, MOST_SEED)


@pytest.mark.parametrize(
    "words",
    [
        ["reconcile", "--machine", "m.json", "--recording", "r.json", "--out", "out"],
        ["dataset", "verify", "out"],
        ["simulate", "--preset", "oscillator"],
    ],
)
def test_every_command_has_the_bound(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        raise SystemExit(main([*words, "--seed", "7" * 40]))
    told = capsys.readouterr().err
    assert ended.value.code == 2 and "--seed" in told and (str(MOST_SEED) in told or "<= 9.0072e+15" in told)
