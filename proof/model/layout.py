"""Where each number stands: degrees of freedom, and the columns of the parameter arrays of the compiled model.

Order of the first 28 degrees of freedom: that of the reference solutions. Then the housings' seats (x, y a bearing)
and one extra support mode a bearing.
"""

from __future__ import annotations

from enum import IntEnum

BEARING_BASE = (1, 9, 14, 22)
"""x_s, y_s, x_p, y_p, y_r of bearings 1 to 4 follow from here."""
INPUT, PINION, GEAR, OUTPUT = 0, 6, 19, 27
"""theta; of the gears x and y follow."""
SEAT, MODE = 28, 36
DOFS = 40
BRISTLE, BOUC, LAG, BRISTLE_RUB = 0, 4, 8, 12
"""First-order states: bristle and hysteresis a bearing, lag a bearing, bristle of the rub."""
STATES = 14
BALLS = 16
"""Most balls a bearing."""


class G(IntEnum):
    """The machine as a whole, SI."""

    IF1 = 0
    IP = 1
    IG = 2
    IF2 = 3
    MP = 4
    MG = 5
    KF1 = 6
    KF2 = 7
    CF = 8
    T = 9
    TOUT = 10
    RB1 = 11
    RB2 = 12
    Z1 = 13
    Z2 = 14
    EM = 15
    E0 = 16
    PHI = 17
    CT = 18
    KM = 19
    """Factor on the mesh stiffness."""
    EPS = 20
    """Contact ratio."""
    A0 = 21
    GOVERNOR = 22
    """Slope of the motor's torque over speed, N m s/rad."""
    RAMP = 23
    """The torque is put on within this time, s; 0: a step."""
    GRAVITY = 24
    """m/s^2 towards -y."""
    SIZE = 25


class B(IntEnum):
    """One bearing with its seat, SI: first the machine, then the effects (0: absent)."""

    KS = 0
    CS = 1
    KPX = 2
    KPY = 3
    CP = 4
    KR = 5
    CR = 6
    MS = 7
    MO = 8
    MR = 9
    KRE = 10
    C0 = 11
    COUNT = 12
    RATIO = 13
    CAGE = 14
    SLIP = 15
    PITCH = 16
    OUTER_WIDTH = 17
    OUTER_DEPTH = 18
    OUTER_ANGLE = 19
    INNER_WIDTH = 20
    INNER_DEPTH = 21
    INNER_ANGLE = 22
    BALL_WIDTH = 23
    BALL_DEPTH = 24
    BALL_ANGLE = 25
    OUTER_WAVE = 26
    OUTER_ORDER = 27
    INNER_WAVE = 28
    INNER_ORDER = 29
    WAVE_PHASE = 30
    FIT = 31
    """0: ring held by its support; 1: loose in an elastic seat; 2: loose in a rigid bore."""
    FIT_GAP = 32
    FIT_K = 33
    FIT_N = 34
    FIT_LOSS = 35
    FIT_MU = 36
    FIT_PRESLIDE = 37
    FIT_SHARE = 38
    """Share of the outer ring's mass that belongs to the seat."""
    LOOSE = 39
    LOOSE_LIFT = 40
    LOOSE_SMOOTH = 41
    HARDENING = 42
    HARDENING_AT = 43
    MODE_MASS = 44
    MODE_HZ = 45
    MODE_ZETA = 46
    MODE_AXIS = 47
    CRACK = 48
    CRACK_PHASE = 49
    FILM = 50
    FILM_GAP = 51
    WHIP = 52
    WHIP_AT = 53
    DRAG2 = 54
    DRAG2_FROM = 55
    CUBIC = 56
    QUINTIC = 57
    BOUC_K = 58
    BOUC_AT = 59
    BOUC_SIGN = 60
    DEAD_K = 61
    DEAD_WIDTH = 62
    DEAD_LAG = 63
    KNOCK = 64
    KNOCK_HZ = 65
    KNOCK_S = 66
    KNOCK_PHASE = 67
    SPALL_ENTRY = 68
    SPALL_EXIT = 69
    SPALL_PEAK = 70
    CREEP = 71
    LIP = 72
    LIP_LENGTH = 73
    SIZE = 74


class M(IntEnum):
    """Effects at the mesh, SI; index + 0 for the pinion, + 1 for the gear where both have one."""

    BACKLASH = 0
    """Width, m; 0: flanks never part."""
    FRICTION = 1
    FRICTION_SPEED = 2
    ECC = 3
    ECC_PHASE = 5
    PROFILE = 7
    PROFILE_WAVES = 9
    SIZE = 11


class X(IntEnum):
    """Effects on shafts and gears, SI; index + 0 for the input shaft or pinion, + 1 for output or gear."""

    UNBALANCE = 0
    UNBALANCE_PHASE = 2
    BOW = 4
    BOW_PHASE = 6
    OFFSET_FORCE = 8
    """Coupling pushed by a parallel offset: stiffness times offset, N."""
    OFFSET_ODD = 10
    OFFSET_PHASE = 12
    ANGLE = 14
    ANGLE_PHASE = 16
    RIPPLE = 18
    RIPPLE_ORDER = 20
    RIPPLE_PHASE = 22
    RUB_K = 24
    RUB_GAP = 26
    RUB_MU = 28
    RUB_LOSS = 30
    STIFFENING = 32
    MAINS_TORQUE = 34
    MAINS_PHASE = 35
    PULL = 36
    PULL_SWING = 37
    PULL_AT = 38
    """0: the pinion's shaft, 1: the gear's."""
    BELT_SHARE = 39
    BELT_RATIO = 40
    BELT_FORCE = 41
    SIZE = 42


class Tooth(IntEnum):
    """One tooth of one gear."""

    PITCH = 0
    """Missing metal, m."""
    CRACK = 1
    """Mean share of the pair's stiffness that is lost over the path of contact."""
    CRACK_FORM = 2
    """0: smooth notch in the middle of the path, 1: grows towards the tip."""
    SPALL = 3
    """Share of the width without contact."""
    SPALL_LENGTH = 4
    SPALL_CENTRE = 5
    MISSING = 6
    SPALL_FLOOR = 7
    """Depth of a spall over the whole width, m."""
    SIZE = 8


TEETH = 128
"""Most teeth a gear."""
