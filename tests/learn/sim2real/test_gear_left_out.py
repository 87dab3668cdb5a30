import numpy as np

from learn.gears import features
from learn.sim2real.gear_left_out import gear_accuracy
from learn.sim2real.gear_table import GearExample


def test_pairs_left_out_tell_what_the_features_are_worth():
    """Of whole recordings the features shift with the class; those of windows are noise."""
    rng = np.random.default_rng(0)

    def example(machine, fault):
        long = rng.standard_normal(len(features.NAMES)) + 3 * (fault != "sound")
        return GearExample(
            label="healthy" if fault == "sound" else "tooth",
            fault=fault,
            machine=machine,
            short=rng.standard_normal((2, len(features.NAMES))),
            long=long,
            clear_db=0.0 if fault == "sound" else 12.0,
            found=True,
        )

    text = gear_accuracy([example(m, fault) for m in range(24) for fault in ("sound", "broken")], seed=0)
    first, second = (
        {cells[1].strip(): cells[2:-1] for line in part.splitlines()[2:] if len(cells := line.split("|")) > 3}
        for part in text.split("\n\n")[1:]
    )
    assert "48 recordings of 24 pairs" in text
    assert float(first["recordings"][0]) > 0.9
    assert float(first["windows of 10 turns"][0]) < 0.7
    assert float(second["broken"][1]) > 0.9
    assert float(second["sound"][1]) < 0.1
    assert second["shows by 10 to 15 dB"][0].strip() == "24"
