"""FLAC by libsndfile: samples as shares of full scale."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import soundfile

from signals.readers.contents import Contents, Entry, told
from signals.readers.limits import Bounds


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Channels `channel1`, `channel2` ... (`channel` if alone), also by number from 0."""
    with told(path):
        about = soundfile.info(str(path))
        count = about.frames * about.channels
        bounds.check(path.name, message="holds too many samples", given=count, allowed=bounds.values, unit="samples")
        samples, rate = soundfile.read(str(path), always_2d=True)
    names = ["channel"] if about.channels == 1 else [f"channel{i + 1}" for i in range(about.channels)]
    entries = {
        name: Entry(load=partial(np.asarray, row), shape=row.shape) for name, row in zip(names, samples.T, strict=True)
    }
    yield Contents(entries=entries, rate_hz=float(rate), numbered=True)
