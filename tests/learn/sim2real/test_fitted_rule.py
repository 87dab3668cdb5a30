import pytest

from learn.sim2real.fitted_rule import fitted_db, refitted


def window(made, label, db, k, rig="cwru"):
    levels = {"outer": db, "inner": db - 3, "ball": db - 5}
    return made.answer(made.case(label, label, rig=rig), "healthy", window=k, levels=levels)


def test_the_threshold_is_the_middle_of_those_that_answer_the_development_rig_best(made):
    rows = [window(made, "healthy", db, k) for k, db in enumerate((6.0, 8.0))]
    rows += [window(made, "outer", db, k) for k, db in enumerate((20.0, 25.0))]
    rows.append(window(made, "healthy", 40.0, 0, rig="another"))
    rule = fitted_db(rows)
    assert rule == pytest.approx(14.0)
    assert [a.label for a in refitted(rows, rule)] == ["healthy", "healthy", "outer", "outer", "outer"]


def test_a_sound_window_above_the_faults_costs_least(made):
    """At 11.5 dB only the loud sound window of four is wrong."""
    rows = [window(made, "healthy", db, k) for k, db in enumerate((5.0, 6.0, 8.0, 30.0))]
    rows += [window(made, "outer", db, k) for k, db in enumerate((15.0, 20.0))]
    assert fitted_db(rows) == pytest.approx(11.5)


def test_without_the_development_rig_there_is_no_threshold(made):
    assert fitted_db([window(made, "outer", 20.0, 0, rig="another")]) is None
    assert refitted([made.answer(made.case("a", "outer"), "outer", window=0)], 14.0) == []
