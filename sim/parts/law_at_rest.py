"""What a force law of the user's own gives at rest, before anything moves."""

from __future__ import annotations

import ctypes

import numpy as np

from sim.core.response import FloatArray
from sim.parts.program_kernel import CONTEXT, KERNEL

ANGLES = 16
_DOUBLES = ctypes.POINTER(ctypes.c_double)
_CALL = ctypes.CFUNCTYPE(None, ctypes.c_int64, *[_DOUBLES] * 6)


def forces_at_rest(parameters: FloatArray) -> FloatArray:
    """Force (ANGLES,) at x = v = 0 over a turn of the shaft, N (N m); `parameters` as the kernel reads them."""
    found = np.empty(ANGLES)
    call = _CALL(KERNEL.force_address)
    for i in range(ANGLES):
        context, force = np.zeros(4 * CONTEXT), np.zeros(4)
        context[0] = 2.0 * np.pi * i / ANGLES
        arrays = (np.zeros(2), np.zeros(2), context, np.ascontiguousarray(parameters), force, np.zeros(16))
        call(0, *(a.ctypes.data_as(_DOUBLES) for a in arrays))
        found[i] = force[0]
    return found
