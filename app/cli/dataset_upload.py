"""`dataset upload`: a finished dataset into a bucket."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tqdm import tqdm

from sim.core.errors import Problem, SpecError
from store.datasets.place import dataset_place

if TYPE_CHECKING:
    from store.datasets.upload import Progress

TEXT = "{n_fmt}/{total_fmt}B {bar} {rate_fmt} [{elapsed}<{remaining}]"


def configure(action: argparse.ArgumentParser) -> None:
    """Declare what the action takes."""
    action.add_argument("out", metavar="DIR", type=Path, help="a finished dataset")
    action.add_argument(
        "url",
        metavar="URL",
        help="s3://BUCKET/PREFIX[?endpoint=http://HOST:PORT&region=NAME]; its keys from the environment",
    )


def run(arguments: argparse.Namespace) -> int:
    """Upload; the same command again goes on where one stopped."""
    place = dataset_place(arguments.url)
    try:
        # Here and not at the top: boto3 is the optional extra `s3`.
        from store.datasets.upload import upload  # noqa: PLC0415
    except ModuleNotFoundError as error:
        message = "needs the client of object stores; install the extra `s3`"
        raise SpecError(Problem(field="URL", message=message, given=arguments.url)) from error
    with _told_to_go_on(), _bar() as bar:
        found = upload(arguments.out, place, arguments.url, lambda progress: show(bar, progress))
    where = f"{arguments.url}: {found.files} files, {found.bytes} bytes"
    print(f"{where}, {found.sent} sent" if found.sent else f"{where}: the same dataset is there, nothing to do")
    return 0


@contextmanager
def _told_to_go_on() -> Iterator[None]:
    try:
        yield
    except KeyboardInterrupt:
        print("to go on: the same command again; readers see no dataset there before it ends", file=sys.stderr)
        raise


@contextmanager
def _bar() -> Iterator[tqdm]:  # type: ignore[type-arg]
    # `disable=None`: a bar on a terminal only, not in a file or a pipe.
    with tqdm(total=0, unit="B", unit_scale=True, disable=None, bar_format=TEXT, file=sys.stderr) as bar:
        yield bar


def show(bar: tqdm, progress: Progress) -> None:  # type: ignore[type-arg]
    """Bring the bar to what is there."""
    if not progress.total:
        if sys.stderr.isatty():
            print(f"{progress.stage} ...", file=sys.stderr)
        return
    if not bar.total:
        # Bytes that were there already say nothing of the rate.
        bar.reset(total=progress.total)
        bar.initial = bar.n = progress.kept
    bar.update(max(0, progress.done - int(bar.n)))
