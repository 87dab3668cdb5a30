"""A finished job's result: signals and spectra as arrays, labelled peaks, files."""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from sideband_client.data import Channel, Signals, Spectrum
from sideband_client.errors import BadReply, NotFound
from sideband_client.files import check_free, whole_file
from sideband_client.transport import Transport

SpectrumKind = Literal["amplitude", "psd", "envelope", "order"]
IndicatorKind = Literal["gear", "average", "cepstrum", "kurtogram", "cyclic"]
SAVED = ("signals.npz", "summary.json", "peaks.json")


class Result:
    """What a successful job left on the server. Nothing is loaded before it is asked for."""

    def __init__(self, transport: Transport, job_id: str) -> None:
        self._transport, self.job_id = transport, job_id
        self._path = f"/v1/jobs/{job_id}/result"

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """Features, quality (energy balance, step error), frequencies in Hz, warnings, table of contents."""
        return self._transport.json("GET", self._path)

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The recorded outputs, in their order."""
        listed = self.summary["channels"]
        return tuple(Channel(**{key: entry[key] for key in Channel.__dataclass_fields__}) for entry in listed)

    def signals(
        self, channels: Sequence[str] | None = None, *, start_s: float | None = None, end_s: float | None = None
    ) -> Signals:
        """Samples with start_s <= t < end_s of the channels named, in that order (default: all)."""
        known = {channel.name: channel for channel in self.channels}
        names = list(known) if channels is None else list(channels)
        query = {"channel": names, "start_s": start_s, "end_s": end_s, "format": "npz"}
        # The server checks the names: its error says which there are.
        reply = self._transport.send("GET", f"{self._path}/signals", query=query)
        try:
            with np.load(io.BytesIO(reply.content), allow_pickle=False) as archive:
                values = np.array([archive[name] for name in names], dtype=np.float64)
                rate_hz, first_s = float(archive["sampling_rate_hz"]), float(archive["start_s"])
            described = tuple(known[name] for name in names)
        except (ValueError, KeyError, OSError, zipfile.BadZipFile) as error:
            raise BadReply(f"the signals are not the npz file that was asked for: {error}") from error
        return Signals(sampling_rate_hz=rate_hz, start_s=first_s, channels=described, values=values)

    def spectrum(self, channel: str, kind: SpectrumKind = "amplitude") -> Spectrum:
        """One stored spectrum, every line of it; raises NotFound with the spectra there are."""
        query = {"channel": channel, "kind": kind}
        found = self._transport.json("GET", f"{self._path}/spectra", query=query)
        try:
            return Spectrum(
                channel=str(found["channel"]),
                kind=str(found["kind"]),
                axis=np.array(found["axis"], dtype=np.float64),
                axis_unit=str(found["axis_unit"]),
                values=np.array(found["values"], dtype=np.float64),
                unit=str(found["unit"]),
                meta=found["meta"],
            )
        except (KeyError, TypeError, ValueError) as error:
            raise BadReply(f"the spectrum lacks or garbles {error}") from error

    def peaks(self, channel: str | None = None) -> Mapping[str, Any]:
        """Labelled peaks of a channel (default: the first acceleration): `frequencies` in Hz, `peaks`, `envelope`."""
        return self._transport.json("GET", f"{self._path}/peaks", query={"channel": channel})

    def indicators(
        self,
        kind: IndicatorKind,
        *,
        channel: str | None = None,
        shaft: str | None = None,
        rotation: Literal["known", "tacholess"] = "known",
        earlier: Sequence[str] = (),
        max_alpha_hz: float | None = None,
        start_s: float | None = None,
        end_s: float | None = None,
    ) -> Mapping[str, Any]:
        """Gear indicators, mean turn, cepstrum, kurtogram or cyclic coherence of a channel (docs/indicators.md).

        `channel` is the first acceleration unless given; `earlier`: ids of jobs, the former runs of NA4 and NB4.
        Raises InvalidRequest with the bound when the record is too long.
        """
        query: dict[str, Any] = {
            "channel": channel,
            "shaft": shaft,
            "rotation": rotation,
            "earlier": list(earlier) or None,
        }
        query |= {"max_alpha_hz": max_alpha_hz, "start_s": start_s, "end_s": end_s}
        return self._transport.json("GET", f"{self._path}/indicators/{kind}", query=query)

    def save(self, folder: str | Path, *, overwrite: bool = False) -> Path:
        """Write signals.npz, summary.json and peaks.json, each whole or not at all; AlreadyThere when one exists.

        The first holds an array for each channel under its name, `sampling_rate_hz`, `start_s` and `description`.
        """
        target = Path(folder)
        if not overwrite:
            check_free(*(target / name for name in SAVED))
        target.mkdir(parents=True, exist_ok=True)
        with (
            self._transport.stream(f"{self._path}/signals?format=npz") as reply,
            whole_file(target / "signals.npz") as stream,
        ):
            for piece in reply.iter_bytes():
                stream.write(piece)
        for name, document in (("summary", self.summary), ("peaks", self.peaks())):
            with whole_file(target / f"{name}.json") as stream:
                stream.write(json.dumps(document, indent=2, ensure_ascii=False).encode())
        return target

    def download(self, name: str, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write a stored file (`signals.f64` ...) as it lies on the server; its SHA-256 is checked on the way.

        Raises AlreadyThere when the file exists.
        """
        if not overwrite:
            check_free(Path(path))
        files = self.summary["files"]
        if name not in files:
            known = ", ".join(files)
            raise NotFound(f"the result has no file {name!r}; it has: {known}", status=404, problem="unknown-part")
        target, digest = Path(path), hashlib.sha256()
        with self._transport.stream(f"{self._path}/files/{name}") as reply, whole_file(target) as stream:
            for piece in reply.iter_bytes():
                digest.update(piece)
                stream.write(piece)
            if digest.hexdigest() != files[name]["sha256"]:
                raise BadReply(f"{name} arrived damaged: its digest is not the one the server has for it")
        return target
