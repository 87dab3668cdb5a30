"""Which sets of the measured recordings are used, which are not and why, and whose bearing nobody has stated."""

from __future__ import annotations

RIGS = ("cwru", "hit_sm_mfs", "uestc", "ims_healthy", "motor_acoustic", "openei_gear")
"""Sets of machines that the model and the detector answer."""
UNUSED = {
    "motor_phone_accel": "a telephone's 99 values a second at stamps that repeat: three orders of the shaft at most",
    "silverbox": "an electronic oscillator",
    "cascaded_tanks": "tanks of water",
    "brfd_backlash": "a friction damper pushed to and fro: nothing turns",
}
"""Sets that are not, with the reason."""
INFERRED = ("uestc",)
"""Rigs whose bearing the source does not state: it was inferred from orders in these very recordings."""
