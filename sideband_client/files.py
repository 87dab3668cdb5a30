"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, cast

from sideband_client.errors import AlreadyThere


def check_free(*targets: Path) -> None:
    """Raise AlreadyThere when one of the files exists."""
    there = [str(target) for target in targets if target.exists()]
    if there:
        raise AlreadyThere(f"already there: {', '.join(there)}; overwrite=True replaces them")


@contextmanager
def whole_file(target: Path) -> Iterator[BinaryIO]:
    """A stream whose content becomes the file when the block ends well; otherwise what was there stays."""
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=".part-")
    try:
        with os.fdopen(handle, "wb") as stream:
            yield cast(BinaryIO, stream)
        Path(temporary).chmod(0o666 & ~_umask())
        Path(temporary).replace(target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _umask() -> int:
    # The only way to read it is to set it.
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
