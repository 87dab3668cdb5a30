"""Which of a term's lines a simulated spectrum shows, against the same machine without the term."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from jobs.demonstration import demonstration
from signals.floor import FloorSettings, noise_floor
from signals.recording import Recording, from_response
from signals.series import Series
from signals.spectra import amplitude_spectrum, envelope_spectrum
from signals.spectra.types import Spectrum
from sim.assembly.assemble import assemble
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.core.terms import Term
from sim.solve.api import simulate
from sim.solve.settings import Settings

BASE = {"mesh_total", "mesh_pairs", "ball_contact", "force_load"}
"""Effects a machine has without asking: nothing else moves at their rates, so their lines need no counterfactual."""
OVER_FLOOR_DB = 12.0
"""One bin of Gaussian noise stands that far above the mean power with probability exp(-10^1.2) = 1.3e-7."""
RISE_DB = 6.0
"""The line at least doubles."""
SETTLING_S, SPAN_S, RATE_HZ = 0.2, 1.0, 12_000.0
"""Resolution 1 Hz: the lowest base frequency of the demo machines is 3 Hz, their nearest lines are 4 Hz apart."""


@dataclass(frozen=True, kw_only=True)
class Shown:
    """A line where it shows best: level over the local floor, and over the line without the term, dB.

    The rise is infinite for the effects of `BASE`. Sidebands count in the amplitude spectrum only: an envelope shows
    what modulates, not what is modulated.
    """

    label: str
    over_floor_db: float
    rise_db: float
    where: str

    @property
    def plain(self) -> bool:
        """Whether the line stands out and would not do so without the term."""
        return self.over_floor_db >= OVER_FLOOR_DB and self.rise_db >= RISE_DB


def demo_machines(term: Term) -> tuple[MachineSpec, MachineSpec]:
    """The term's demonstration, and the same machine without the term."""
    shown = demonstration(term)
    return shown.machine, shown.without


def promised(term: Term, system: System, without: System) -> list[Line]:
    """The leading lines: the term's own, else those of other effects whose rate it changes."""
    own = [line for line in system.lines if line.mechanism == term.key]
    moved = {base for base, hz in system.bases_hz.items() if hz != without.bases_hz.get(base)}
    lines = own or [line for line in system.lines if moved & {base for base, _ in line.orders}]
    found = {line.label: line for line in reversed(lines) if line.component == lines[0].component}
    return list(reversed(found.values()))[: term.demo.leading]


@cache
def _recorded(document: str, span_s: float) -> Recording:
    machine = MachineSpec.model_validate_json(document)
    run = simulate(
        machine,
        duration_s=SETTLING_S + span_s,
        output_rate_hz=RATE_HZ,
        settings=Settings(estimate_error=False),
    )
    return from_response(run).select(start_s=SETTLING_S)


def recorded(machine: MachineSpec, span_s: float = SPAN_S) -> Recording:
    """Sensor signals after the start-up, one run a machine."""
    return _recorded(machine.model_dump_json(), span_s)


def spectra(series: Series, other: Series) -> list[tuple[Spectrum, Spectrum]]:
    """Amplitude spectra of both, and envelope spectra of the band that suits the first."""
    first = envelope_spectrum(series)
    assert first.band is not None
    return [
        (amplitude_spectrum(series), amplitude_spectrum(other)),
        (first, envelope_spectrum(other, band=first.band)),
    ]


def amplitude_at(spectrum: Spectrum, frequency_hz: float) -> float:
    """Largest of the three bins around a frequency."""
    nearest = round(frequency_hz / spectrum.resolution_hz)
    return float(np.max(spectrum.values[nearest - 1 : nearest + 2]))


def shown(
    term: Term, lines: list[Line], with_term: MachineSpec, without: MachineSpec, span_s: float = SPAN_S
) -> list[Shown]:
    """How plainly each line shows on the sensor and in the spectrum that shows it best."""
    bases = assemble(with_term).bases_hz
    here, there = recorded(with_term, span_s), recorded(without, span_s)
    pairs = [
        (f"{kind} spectrum of {name}", a, b, noise_floor(a, FloorSettings()).level)
        for name in here.names
        for kind, (a, b) in zip(("amplitude", "envelope"), spectra(here.series(name), there.series(name)), strict=True)
    ]
    found = []
    for line in lines:
        hz = line.frequency_hz(bases)
        views = []
        for where, a, b, floor in pairs:
            if hz < a.frequency_hz[-2] and (a.kind == "amplitude" or len(line.orders) == 1):
                level = amplitude_at(a, hz)
                over = 20 * np.log10(level / floor[round(hz / a.resolution_hz)])
                rise = np.inf if term.key in BASE else 20 * np.log10(level / amplitude_at(b, hz))
                if term.demo.falls:
                    rise, over = -rise, over - rise
                views.append(Shown(label=line.label, over_floor_db=over, rise_db=rise, where=where))
        found.append(max(views, key=lambda v: min(v.over_floor_db - OVER_FLOOR_DB, v.rise_db - RISE_DB)))
    return found
