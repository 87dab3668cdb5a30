"""A physics that is quick, obedient and misbehaves on request, for tests of everything around the physics.

The machine's notes say what to do: `sleep=2` simulates for two seconds of wall time, `deaf` ignores cancellation,
`diverge`, `crash` (the process dies), `crash-once=PATH` (dies unless PATH exists, and makes it), `error`, `memory`.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from jobs.documents import ResultDocuments, SpectrumDocument
from jobs.ports import MachineReport
from jobs.record import Cost
from sim.core.errors import Cancelled, Diverged, Problem, SpecError, UnknownName
from sim.core.response import Channel, EnergyBalance, Quality, Response
from sim.core.spec import BodySpec, MachineSpec

VERSION = "fake-1"
CHANNELS = (
    Channel(name="mass.y.displacement", quantity="displacement", unit="m", location="mass", axis="y"),
    Channel(name="mass.y.acceleration", quantity="acceleration", unit="m/s^2", location="mass", axis="y"),
)
TONE_HZ = 40.0


def machine(notes: str = "", *, stiffness: float = 63165.0) -> MachineSpec:
    """A mass on a spring."""
    body = BodySpec(name="mass", mass_kg=1.0, axes="y", stiffness_y_n_per_m=stiffness)
    return MachineSpec(name="oscillator", notes=notes, bodies=[body])


class FakeEngine:
    """`jobs.ports.Engine` without physics."""

    version = VERSION

    def warm(self) -> None:
        """Nothing to compile."""

    def preset_names(self) -> tuple[str, ...]:
        return ("oscillator", "slow")

    def preset(self, name: str) -> MachineSpec:
        return machine("sleep=3" if name == "slow" else "")

    def terms(self) -> list[dict[str, object]]:
        return [{"key": "fit_clearance", "sites": ["bearing"], "parameters": []}]

    def example(self, key: str) -> dict[str, object]:
        self.examples = getattr(self, "examples", 0) + 1
        return {"key": key, "made": self.examples}

    def law(self, key: str) -> dict[str, object]:
        self.laws = getattr(self, "laws", 0) + 1
        return {"key": key, "made": self.laws}

    def bearings(self) -> list[dict[str, object]]:
        return [{"designation": "6203", "balls": 8}]

    def missing_bearings(self) -> dict[str, str]:
        return {"6204": "no source"}

    def report(self, machine: MachineSpec) -> MachineReport:
        if not machine.bodies:
            raise SpecError(Problem(field="machine.bodies", message="the machine has no mass", allowed="at least one"))
        unknown = [t.term for t in machine.terms if t.term != "fit_clearance"]
        if unknown:
            raise UnknownName("term", unknown[0], ("fit_clearance",))
        return MachineReport(
            bases_hz={"f_r1": TONE_HZ},
            channels=tuple(c.name for c in CHANNELS),
            default_channels=tuple(c.name for c in CHANNELS),
            derived={},
            natural_frequencies_hz=(TONE_HZ,),
            warnings=(),
        )

    def cost(
        self, machine: MachineSpec, *, duration_s: float, sampling_rate_hz: float, channels: Sequence[str] | None
    ) -> Cost:
        steps = int(duration_s * sampling_rate_hz)
        return Cost(steps=steps, memory_bytes=16 * steps, seconds=steps * 1e-7)

    def simulate(
        self,
        machine: MachineSpec,
        *,
        duration_s: float,
        sampling_rate_hz: float,
        channels: Sequence[str] | None,
        seed: int,
        progress: Callable[[float], None],
        cancelled: Callable[[], bool],
        estimate_error: bool = True,
    ) -> Response:
        orders = dict(part.partition("=")[::2] for part in machine.notes.split(";") if part)
        _misbehave(orders)
        _spend(float(orders.get("sleep", 0)), progress, cancelled if "deaf" not in orders else lambda: False)
        t = np.arange(int(duration_s * sampling_rate_hz)) / sampling_rate_hz
        noise = np.random.default_rng(seed).normal(size=t.size) * 1e-3
        y = np.sin(2 * np.pi * TONE_HZ * t) + noise
        rows = {CHANNELS[0].name: y, CHANNELS[1].name: -((2 * np.pi * TONE_HZ) ** 2) * y}
        wanted = [c for c in CHANNELS if channels is None or c.name in channels]
        return _response(machine, wanted, np.array([rows[c.name] for c in wanted]), sampling_rate_hz, seed)


def _misbehave(orders: dict[str, str]) -> None:
    if "diverge" in orders:
        raise Diverged(time_s=0.0123, dof="mass.y", advice="take a smaller step")
    if "memory" in orders:
        raise MemoryError
    if "error" in orders:
        raise RuntimeError("/secret/path went wrong")
    marker = Path(orders["crash-once"]) if "crash-once" in orders else None
    if "crash" in orders or (marker is not None and not marker.exists()):
        if marker is not None:
            marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)


def _spend(seconds: float, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
    start = time.monotonic()
    while (spent := time.monotonic() - start) < seconds:
        if cancelled():
            raise Cancelled("cancelled")
        progress(spent / seconds)
        time.sleep(0.02)


def _response(machine: MachineSpec, channels: list[Channel], signals: np.ndarray, rate: float, seed: int) -> Response:
    energy = EnergyBalance(work_j={}, stored_j={}, dissipated_j={}, residual_j=0.0, scale_j=1.0, limit=1e-3)
    quality = Quality(
        step_s=1 / rate,
        steps=signals.shape[1],
        refined_steps=0,
        unconverged_steps=0,
        step_error=None,
        step_error_kind="not measured",
        transient_end_s=0.0,
        energy=energy,
    )
    return Response(
        machine=machine,
        sampling_rate_hz=rate,
        channels=tuple(channels),
        signals=signals,
        bases_hz={"f_r1": TONE_HZ},
        derived={},
        quality=quality,
        warnings=(),
        contact_share={},
        seed=seed,
        version=VERSION,
    )


def analyse(response: Response, *, discard_transient: bool) -> ResultDocuments:
    """Amplitude spectra, one peak."""
    n = response.signals.shape[1]
    axis = np.fft.rfftfreq(n, 1 / response.sampling_rate_hz)
    spectra = tuple(
        SpectrumDocument(
            channel=channel.name,
            kind="amplitude",
            axis=axis,
            axis_unit="Hz",
            values=np.abs(np.fft.rfft(row)) * 2 / n,
            unit=channel.unit,
            meta={"amplitude": "peak", "window": "boxcar"},
        )
        for channel, row in zip(response.channels, response.signals, strict=True)
    )
    peak = {
        "label": "1*f_r1",
        "frequency_hz": TONE_HZ,
        "order": 1.0,
        "amplitude": 1.0,
        "unit": "m",
        "status": "present",
    }
    return ResultDocuments(
        summary={"transient_discarded": discard_transient, "features": {}},
        peaks={"frequencies": {"f_r1": TONE_HZ}, "peaks": [peak]},
        spectra=spectra,
    )
