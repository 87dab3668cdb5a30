"""Indicators of a result folder or of a recording, printed as JSON.

Kinds: gear (FM0, FM4, M6A, M8A, NA4, NB4 ...), average (mean turn), cepstrum, kurtogram, cyclic (coherence).
A result folder knows its machine. A recording (npz, mat, wav, csv, described by a JSON file of the same stem or by
--rate and --unit) needs --speed, and --teeth for gears.

Example: sideband analyse result-paper-demo --indicator gear
         sideband analyse DE.npz --rate 48000 --unit g --speed 29.93 --indicator cyclic
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from app.cli.choice import read_machine
from app.cli.files import json_text, read_json
from app.cli.recordings import Given, read_recording
from jobs.indicators import KINDS, Rotation, Subject, indicators, of_recording
from jobs.indicators.subject import of_simulation
from signals.series import Series
from sim.core.errors import Problem, SidebandError, SpecError, UnknownName

PREFERRED = ("acceleration", "angular_acceleration")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("source", metavar="RESULT_OR_RECORDING", type=Path, help="a result folder, or a recording")
    parser.add_argument(
        "--indicator",
        metavar="KIND",
        action="append",
        choices=KINDS,
        help=f"one of {', '.join(KINDS)}; may be repeated",
    )
    parser.add_argument("--channel", metavar="NAME", help="channel (default: the first acceleration, else the first)")
    parser.add_argument("--shaft", metavar="NAME", help="shaft, by name or base (f_r1); default: those with gears")
    parser.add_argument(
        "--tacholess", action="store_true", help="take the shaft's angle from the vibration, within 10 %% of its speed"
    )
    parser.add_argument(
        "--earlier",
        metavar="SOURCE",
        type=Path,
        nargs="+",
        default=[],
        help="former runs that NA4 and NB4 average over",
    )
    parser.add_argument("--max-alpha", metavar="HZ", type=float, help="largest cyclic frequency (cyclic)")
    parser.add_argument("--rate", metavar="HZ", type=float, help="sampling rate of a recording")
    parser.add_argument("--unit", metavar="UNIT", help="unit of a recording's channels ('1': dimensionless)")
    parser.add_argument(
        "--speed", metavar="HZ", type=float, help="speed of a recording's shaft, revolutions per second"
    )
    parser.add_argument(
        "--teeth", metavar="N", type=int, nargs="+", default=[], help="teeth of the gears on that shaft"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    subject, *earlier = [_subject(path, arguments) for path in (arguments.source, *arguments.earlier)]
    rotation: Rotation = "tacholess" if arguments.tacholess else "known"
    documents = [
        indicators(
            kind,
            subject,
            shaft=arguments.shaft,
            rotation=rotation,
            earlier=earlier,
            max_alpha_hz=arguments.max_alpha,
        )
        for kind in arguments.indicator or ["gear"]
    ]
    print(json_text(documents[0] if len(documents) == 1 else documents), end="")
    return 0


def _subject(path: Path, arguments: argparse.Namespace) -> Subject:
    if not path.exists():
        raise SpecError(Problem(field=str(path), message="does not exist"))
    if path.is_dir():
        given = [f"--{name}" for name in ("rate", "unit", "speed", "teeth") if getattr(arguments, name)]
        if given:
            message = "are for recordings; a result folder says them itself"
            raise SpecError(Problem(field=", ".join(given), message=message))
        return _of_folder(path, arguments.channel)
    if arguments.rate is not None and not (np.isfinite(arguments.rate) and arguments.rate > 0):
        raise SpecError(Problem(field="--rate", message="must be positive", given=arguments.rate, unit="Hz"))
    recording = read_recording(path, Given(sampling_rate_hz=arguments.rate, unit=arguments.unit))
    quantities = {channel.name: channel.quantity for channel in recording.channels}
    channel = _chosen(arguments.channel, recording.names, quantities)
    return of_recording(recording, channel, speed_hz=arguments.speed, teeth=tuple(arguments.teeth))


def _of_folder(folder: Path, wanted: str | None) -> Subject:
    """A channel of a folder that `sideband simulate` wrote, from where its analysis begins."""
    missing = [name for name in ("signals.npz", "summary.json", "machine.json") if not (folder / name).is_file()]
    if missing:
        message = f"is no result folder: {', '.join(missing)} not there"
        raise SpecError(Problem(field=str(folder), message=message, allowed="a folder that `sideband simulate` wrote"))
    summary, machine = read_json(folder / "summary.json"), read_machine(folder / "machine.json")
    try:
        rate, start_s = float(str(summary["sampling_rate_hz"])), float(str(summary["analysed_from_s"]))
        channels, bases = summary["channels"], summary["frequencies"]
        assert isinstance(channels, list) and isinstance(bases, dict)
        by_name = {str(c["name"]): c for c in channels}
        name = _chosen(wanted, tuple(by_name), {n: str(c["quantity"]) for n, c in by_name.items()})
        first = round(start_s * rate)
        with np.load(folder / "signals.npz", allow_pickle=False) as file:
            samples = file[name][first:]
        unit, seed = str(by_name[name]["unit"]), int(str(summary["seed"]))
    except SidebandError:
        raise
    except (KeyError, ValueError, AssertionError) as error:
        message = f"does not hold what a result folder holds: {error}"
        raise SpecError(Problem(field=str(folder), message=message)) from error
    series = Series(samples=samples, sampling_rate_hz=rate, unit=unit, name=name, start_s=first / rate)
    return of_simulation(series, machine, bases, seed)


def _chosen(wanted: str | None, names: Sequence[str], quantities: dict[str, str]) -> str:
    if wanted is not None:
        if wanted not in names:
            raise UnknownName("channel", wanted, names)
        return wanted
    ranked = [name for quantity in PREFERRED for name in names if quantities.get(name) == quantity]
    return (ranked or list(names))[0]
