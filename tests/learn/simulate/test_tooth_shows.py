import numpy as np

from learn.gears.turns import finer, turns_of
from learn.simulate.tooth_shows import SHOWS_DB, tooth_db


def test_a_tooth_shows_when_it_stands_above_the_rest_of_the_turn(stage):
    sound, angle = stage(noise=0.1)
    rng = np.random.default_rng(9)

    def shown(faulty):
        one, other = (turns_of(finer(x), angle, (23, 57), 0) for x in (sound, faulty))
        return tooth_db(one, other)

    assert shown(stage(tooth=0, noise=0.1)[0]) > SHOWS_DB + 6
    assert shown(stage(tooth=0, noise=0.1, size=0.005)[0]) < SHOWS_DB
    assert shown(sound) == -np.inf
    assert shown(sound + rng.standard_normal(sound.size)) == -np.inf
