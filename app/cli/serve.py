"""Start the service: embedded broker, workers, HTTP interface and dashboard. Ctrl-C stops it in order.

REDIS_URL, DATABASE_URL and ARTEFACT_URL name outside stores instead of the embedded ones.

Example: sideband serve --port 8001 --demo --open
"""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from app.settings import settings_for_everything
from sim.core.errors import Problem, SpecError
from sim.loading import loading

MAX_WORKERS = 256


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("--host", help="address to listen on (default: SIDEBAND_HOST or 127.0.0.1)")
    parser.add_argument("--port", type=int, help="port, 0 for any free one (default: SIDEBAND_PORT or 8000)")
    parser.add_argument("--workers", type=int, metavar="N", help="worker processes (default: one a core)")
    parser.add_argument("--data", metavar="DIR", type=Path, help="data folder (default: SIDEBAND_DATA_DIR or ./data)")
    parser.add_argument("--demo", action="store_true", help="simulate the paper's machine and show its result page")
    parser.add_argument("--open", action="store_true", help="open the dashboard in a browser")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    settings = settings_for_everything()
    port = settings.port if arguments.port is None else arguments.port
    workers = 1 if arguments.workers is None else arguments.workers
    checks = (
        ("--port", port, 0 <= port <= 65535, "0 to 65535"),
        ("--workers", workers, 1 <= workers <= MAX_WORKERS, f"1 to {MAX_WORKERS}"),
    )
    wrong = [Problem(field=n, message="is out of bounds", given=v, allowed=a) for n, v, good, a in checks if not good]
    if wrong:
        raise SpecError(wrong)
    # The service is loaded for settings that can be used: wrong ones are told at once.
    with loading():
        service = importlib.import_module("app.serve")
    code: int = service.serve(
        host=arguments.host or settings.host,
        port=port,
        workers=arguments.workers,
        data_dir=arguments.data,
        open_browser=arguments.open,
        demo=arguments.demo,
    )
    return code
