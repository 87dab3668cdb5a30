from learn.sim2real.figures import controls, other_rigs, paired, pooled, rigs, stated_bearings


def some(made):
    """A rig of two classes, one of sound recordings alone with false alarms, and the development rig."""
    both = [made.case("a", "healthy"), made.case("b", "outer")]
    sound = made.case("c", "healthy", rig="still")
    own = made.case("d", "ball", rig="cwru")
    return [
        *(made.answer(c, c.label) for c in both),
        made.answer(both[1], "inner", window=0),
        made.answer(sound, "healthy"),
        *(made.answer(sound, said, window=k) for k, said in enumerate(("ball", "healthy", "ball"))),
        made.answer(own, "ball"),
    ]


def test_a_rig_of_one_class_is_a_control_and_no_rig(made):
    found = some(made)
    assert set(rigs(found)) == {"one", "one_windows"}
    assert rigs(found)["one"]["balanced_accuracy"] == 1.0
    assert controls(found) == {
        "still": {"unit": "recording", "n": 1, "false_alarms": 0},
        "still_windows": {"unit": "window", "n": 3, "false_alarms": 2},
    }


def test_a_rig_of_one_fault_is_no_control(made):
    assert controls([made.answer(made.case("a", "ball"), "healthy")]) == {}


def test_pooled_counts_rigs_of_one_class_too(made):
    found = pooled(some(made))
    assert (found["n"], found["balanced_accuracy"]) == (4, 1.0)
    assert found["windows"]["n"] == 4
    assert found["windows"]["balanced_accuracy"] == round((1 / 3 + 0) / 2, 4)


def test_the_development_rig_can_be_left_out(made):
    assert pooled(other_rigs(some(made)))["classes"] == ["healthy", "outer"]


def test_rigs_whose_bearing_was_inferred_can_be_left_out(made):
    guessed = made.answer(made.case("e", "inner", rig="uestc"), "inner")
    assert "inner" not in pooled(stated_bearings([*some(made), guessed]))["classes"]


def test_pairs_count_recordings_and_not_windows(made):
    cases = [made.case(name, "outer") for name in "abc"]
    said = {"a": ("outer", "outer"), "b": ("outer", "ball"), "c": ("ball", "ball")}
    rival = {"a": ("ball", "ball"), "b": ("ball", "outer"), "c": ("ball", "outer")}
    one, other = (
        [made.answer(c, label, window=k) for c in cases for k, label in enumerate(way[c.name])] for way in (said, rival)
    )
    found = paired(one, other, "window")
    assert (found["recordings"], found["better"], found["worse"], found["sign_test_p"]) == (3, 1, 1, 1.0)
    assert paired(one, other, "recording")["recordings"] == 0
