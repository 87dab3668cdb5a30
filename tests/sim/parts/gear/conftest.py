"""Gears used by several tests."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sim.parts.gear import GearGeometry, GearPair, RootModel

MakePair = Callable[..., GearPair]


@pytest.fixture
def paper_pair() -> MakePair:
    """Pair of the seed's Table 3 with the reference's ha* = 1, c* = 0.25, nu = 0.3, bore 0.3 r."""

    def build(
        youngs_modulus_pa: float = 2.16e11, root_model: RootModel = "clamped_at_base", mean_deflection_m: float = 1e-5
    ) -> GearPair:
        def gear(teeth: int) -> GearGeometry:
            return GearGeometry(
                teeth=teeth,
                module_m=2e-3,
                face_width_m=0.024,
                bore_radius_m=0.3 * teeth * 1e-3,
                youngs_modulus_pa=youngs_modulus_pa,
            )

        return GearPair(pinion=gear(23), gear=gear(81), root_model=root_model, mean_deflection_m=mean_deflection_m)

    return build
