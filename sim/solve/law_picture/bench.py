"""One element on the bench: the compiled kernel that the solver calls, at an angle, a displacement and a velocity."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from sim.core.elements import OUT_ENERGY, STAGES, Element
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.collocation import collocation
from sim.solve.plain import shaft_rows, step_array

_PREPARE = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 5)
_FORCE = ctypes.CFUNCTYPE(None, ctypes.c_int64, *[ctypes.c_void_p] * 6)
"""With addresses of doubles."""
_rule = cache(collocation)


@lru_cache(maxsize=256)
def _prepare_at(address: int) -> Callable[..., None]:
    return _PREPARE(address)


@lru_cache(maxsize=256)
def _force_at(address: int) -> Callable[..., None]:
    return _FORCE(address)


@dataclass(frozen=True, kw_only=True)
class Bench:
    """An element of a machine, everything else of the machine at rest."""

    system: System
    element: Element

    @property
    def speed_rad_per_s(self) -> float:
        """Of the first shaft that the element follows; 0 where it follows none."""
        return 2.0 * np.pi * self.system.speeds_hz[self.element.shafts[0]]

    def zeros(self) -> FloatArray:
        """Coordinates at rest, (size,)."""
        return np.zeros(self.element.size)

    def row(self, time_s: float, u: FloatArray | None = None, *, still: bool = False) -> FloatArray:
        """Context of the instant `time_s` of the machine's nominal turning; `still`: at that angle, but not turning."""
        rule = _rule(STAGES)
        step = step_array(time_s, 0.0, rule.c, rule.lagrange, rule.b)
        shafts = shaft_rows(self.system, self.element, step, np.zeros(2 * len(self.system.dofs)))
        if still:
            shafts[[1, 3]] = 0.0
        start = np.concatenate([self.zeros() if u is None else u, self.zeros()])
        context = np.zeros((STAGES + 1, self.element.context))
        arguments = (step, np.ascontiguousarray(shafts), start, self.element.parameters, context)
        _prepare_at(self.element.kernel.prepare_address)(*(a.ctypes.data for a in arguments))
        return np.array(context[STAGES if self.element.exact_end else STAGES - 1])

    def force(self, row: FloatArray, u: FloatArray, ud: FloatArray | None = None) -> FloatArray:
        """Resistance (forces,), N or N m."""
        return self._call(row, u, ud)[0]

    def outputs(self, row: FloatArray, u: FloatArray) -> FloatArray:
        """What the element reports, in the order of its outputs."""
        return self._call(row, u, None)[1]

    def _call(self, row: FloatArray, u: FloatArray, ud: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        d, forces = self.element.size, self.element.forces
        f = np.zeros(max(forces, 4))
        out = np.zeros(max(2 * forces * d, OUT_ENERGY + len(self.element.outputs), 16))
        given = (np.ascontiguousarray(a) for a in (u, self.zeros() if ud is None else ud, row))
        arguments = (*given, self.element.parameters, f, out)
        _force_at(self.element.kernel.force_address)(2, *(a.ctypes.data for a in arguments))
        return f[:forces], out[OUT_ENERGY : OUT_ENERGY + len(self.element.outputs)]
