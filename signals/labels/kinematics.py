"""Which frequencies of a machine are tied to which: shafts, meshes and bearings as the labels need them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class ShaftKinematics:
    """A shaft turning at the base `base` (`f_r1`); `component` is its site (`input`)."""

    base: str
    component: str


@dataclass(frozen=True, kw_only=True)
class MeshKinematics:
    """Two gears in mesh: `base` (`f_m`) = pinion_teeth * pinion_shaft = gear_teeth * gear_shaft."""

    base: str
    pinion_shaft: str
    pinion_teeth: int
    gear_shaft: str
    gear_teeth: int
    component: str = "mesh1"
    pinion: str = "pinion"
    gear: str = "gear"


@dataclass(frozen=True, kw_only=True)
class BearingKinematics:
    """A rolling bearing with its inner ring on shaft `shaft`: bases f_o, f_i, f_b, f_c with `index` behind.

    `balls` ties f_o = balls * f_c and f_i = balls * (f_r - f_c). `diameter_ratio` is d/D cos(alpha): bearings that
    share it have equal orders by construction, and equal ball lines if they share `ball_order` = f_b / f_r too (it
    differs where the contact angle does). Both are compared, not used as numbers.
    """

    index: int
    shaft: str
    balls: int
    diameter_ratio: float
    ball_order: float = 0.0
    component: str = ""

    @property
    def site(self) -> str:
        """Name of the component, `bearing1` unless given."""
        return self.component or f"bearing{self.index}"

    def base(self, letter: str) -> str:
        """Name of a base of this bearing: `o`, `i`, `b` or `c`."""
        return f"f_{letter}{self.index}"


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """All of a machine's ties."""

    shafts: tuple[ShaftKinematics, ...] = ()
    meshes: tuple[MeshKinematics, ...] = ()
    bearings: tuple[BearingKinematics, ...] = ()
