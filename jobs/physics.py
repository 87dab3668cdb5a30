"""`jobs.ports.Engine` on the simulation core."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from threading import Lock

from jobs.cost import Run, expected
from jobs.example import example
from jobs.identity import canonical_json
from jobs.law_document import law_document
from jobs.ports import MachineReport
from jobs.record import Cost
from jobs.term_document import term_document
from sim import presets
from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.errors import UnknownName
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.parts.bearing.catalogue import catalogue, missing
from sim.solve.api import default_channels, resolve_channels, simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from sim.terms import REGISTRY
from sim.version import PHYSICS_VERSION

KEPT_SYSTEMS = 32
WARM_PRESET = "paper-demo"
WARM_S = 0.01


class PhysicsEngine:
    """The simulation core. Assembled machines are kept for a while: checking, costing and asking again share them."""

    def __init__(self) -> None:
        self._systems: OrderedDict[str, System] = OrderedDict()
        self._lock = Lock()
        self._examples = Lock()

    @property
    def version(self) -> str:
        """Part of every job's identity."""
        return PHYSICS_VERSION

    def warm(self, *, lanes: bool = False) -> None:
        """Load the compiled kernels by a very short run; `lanes`: those of machines side by side too."""
        machine = presets.preset(WARM_PRESET)
        simulate(machine, duration_s=WARM_S, output_rate_hz=20_000.0)
        if lanes:
            simulate_many([Member(machine=machine)], duration_s=WARM_S, output_rate_hz=20_000.0)

    def preset_names(self) -> tuple[str, ...]:
        """Names of the preset machines."""
        return tuple(presets.names())

    def preset(self, name: str) -> MachineSpec:
        """A preset machine."""
        return presets.preset(name)

    def terms(self) -> list[dict[str, object]]:
        """Every registered effect as a document."""
        return [term_document(term) for term in REGISTRY]

    def example(self, key: str) -> dict[str, object]:
        """An effect at work on its demonstration machine; raises UnknownName. Takes about half a second."""
        term = REGISTRY.get(key)
        if term is None:
            raise UnknownName("term", key, REGISTRY.keys())
        # One at a time: whoever opens many pages must not take every core from the workers.
        with self._examples:
            return example(term)

    def law(self, key: str) -> dict[str, object]:
        """Pictures of an effect's law; raises UnknownName. Takes a second or two."""
        term = REGISTRY.get(key)
        if term is None:
            raise UnknownName("term", key, REGISTRY.keys())
        with self._examples:
            return law_document(term)

    def bearings(self) -> list[dict[str, object]]:
        """The bearing catalogue."""
        return [vars(row) | {"published_orders": dict(row.published_orders)} for row in catalogue().values()]

    def missing_bearings(self) -> dict[str, str]:
        """Sizes left out of the catalogue, with the reason."""
        return dict(missing())

    def report(self, machine: MachineSpec) -> MachineReport:
        """What assembly says; raises SpecError or UnknownName."""
        system = self._assembled(machine)
        return MachineReport(
            bases_hz=system.bases_hz,
            channels=tuple(channel.name for channel in system.channels),
            default_channels=default_channels(system),
            derived=system.derived,
            natural_frequencies_hz=tuple(float(f) for f in natural_frequencies_hz(system)),
            warnings=system.warnings,
        )

    def cost(
        self, machine: MachineSpec, *, duration_s: float, sampling_rate_hz: float, channels: Sequence[str] | None
    ) -> Cost:
        """What a run would take."""
        system = self._assembled(machine)
        count = len(resolve_channels(system, channels))
        found = expected(system, Run(duration_s=duration_s, sampling_rate_hz=sampling_rate_hz, channels=count))
        return Cost(steps=found.steps, memory_bytes=found.memory_bytes, seconds=found.seconds)

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
        """Simulate from rest."""
        return simulate(
            machine,
            duration_s=duration_s,
            output_rate_hz=sampling_rate_hz,
            channels=channels,
            seed=seed,
            progress=progress,
            cancelled=cancelled,
            settings=Settings(estimate_error=estimate_error),
        )

    def _assembled(self, machine: MachineSpec) -> System:
        key = canonical_json(machine.model_dump(mode="json"))
        with self._lock:
            known = self._systems.get(key)
            if known is not None:
                self._systems.move_to_end(key)
                return known
        system = assemble(machine)
        with self._lock:
            self._systems[key] = system
            while len(self._systems) > KEPT_SYSTEMS:
                self._systems.popitem(last=False)
        return system
