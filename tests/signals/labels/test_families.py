"""The families of lines."""

from gearbox import BASES, KINEMATICS, LINES

from signals.labels import Bound, kinematic_lines


def labels(family: str, component: str) -> set[str]:
    return {x.label for x in LINES if x.family == family and x.component == component}


def test_families_hold_what_the_literature_lists() -> None:
    assert {"1*f_o1", "12*f_o1"} <= labels("outer", "bearing1")
    assert {"1*f_i1", "1*f_i1-1*f_r1", "2*f_i1+2*f_r1"} <= labels("inner", "bearing1")
    assert {"2*f_b3", "2*f_b3-1*f_c3", "4*f_b3+2*f_c3"} <= labels("ball", "bearing3")
    assert not any(x.label.startswith("1*f_b") for x in LINES)  # a ball defect strikes twice a spin
    assert "1*f_c1" in labels("cage", "bearing1")
    assert {"1*f_m", "7*f_m"} <= labels("mesh", "mesh1")
    assert {"1*f_m-1*f_r1", "7*f_m+5*f_r1"} <= labels("mesh", "pinion")
    assert "1*f_m+1*f_r2" in labels("mesh", "gear")
    assert "1*f_m-1*f_o1" in labels("mesh", "bearing1")
    assert "3*f_r2" in labels("shaft", "output")


def test_bounds_and_the_end_of_the_axis_are_kept() -> None:
    bound = Bound(mesh=2, mesh_shaft_sidebands=1, mesh_outer_sidebands=0, outer=3)
    lines = kinematic_lines(KINEMATICS, BASES, max_frequency_hz=1000.0, bound=bound)
    assert all(0 < x.frequency_hz(BASES) <= 1000.0 for x in lines)
    names = {x.label for x in lines}
    assert "1*f_m-1*f_r1" in names
    assert not names & {"1*f_m-2*f_r1", "4*f_o1", "2*f_m", "1*f_m+1*f_o1"}


def test_bearings_without_frequencies_have_no_lines() -> None:
    few = {k: v for k, v in BASES.items() if not k.endswith("4") or k.startswith("f_r")}
    assert not any(x.component == "bearing4" for x in kinematic_lines(KINEMATICS, few, max_frequency_hz=5000.0))
