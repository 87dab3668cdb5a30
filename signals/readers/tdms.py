"""TDMS (LabVIEW) by npTDMS: channels with their waveform's increment as the rate."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from nptdms import TdmsChannel, TdmsFile

from signals.readers.contents import AnyArray, Contents, Entry, numeric, told
from signals.readers.limits import Bounds


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Channels as `group/channel`, and by the channel's name alone where no other group has it; by number in order."""
    with told(path):
        file = TdmsFile.open(path)
    with file:
        with told(path):
            channels = [(group.name, channel) for group in file.groups() for channel in group.channels()]
            bounds.check_members(path.name, len(channels), "channels")
            names = [channel.name for _, channel in channels]
            entries = {
                (channel.name if names.count(channel.name) == 1 else f"{group}/{channel.name}"): _entry(path, channel)
                for group, channel in channels
            }
            aliases = {f"{group}/{c.name}": c.name for group, c in channels if c.name in entries}
        yield Contents(entries=entries, aliases=aliases, numbered=True)


def _entry(path: Path, channel: TdmsChannel) -> Entry:
    step = float(channel.properties.get("wf_increment", 0.0) or 0.0)
    return Entry(
        load=partial(_load, path, channel),
        shape=(len(channel),),
        rate_hz=1 / step if step > 0 else None,
        unit=str(channel.properties.get("unit_string", channel.properties.get("NI_UnitDescription", ""))),
    )


def _load(path: Path, channel: TdmsChannel) -> AnyArray:
    with told(path):
        return numeric(path, channel.name, channel[:])
