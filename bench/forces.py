"""`python -m bench.forces`: how near the force by lines comes on made gearboxes, 20 s each on one core.

On a support of a gearbox that differs from the drawing acts a law or a sum of five sines; three sensors with gains and
noise of their own record it at three speeds, and the gearbox without it. Asked is the engine's estimate there.
"""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # must be set before numpy is imported

import argparse  # noqa: E402
from collections.abc import Sequence  # noqa: E402
from dataclasses import dataclass  # noqa: E402

import numpy as np  # noqa: E402

from reconcile.atlas.candidates import with_effects  # noqa: E402
from reconcile.atlas.keep import Keeper, kept_bank  # noqa: E402
from reconcile.atlas.places import simulated_channels, standard_channels  # noqa: E402
from reconcile.atlas.plan import AtlasPlan, Point, at_point, atlas_plan, simulated_at, slips, with_tooth_pairs  # noqa: E402
from reconcile.calibrate.uncertain import DRIFT, draw_offsets, moved, uncertain_numbers  # noqa: E402
from reconcile.judge.changes import healthy_of, lenses, observed_changes  # noqa: E402
from reconcile.machine.added_power import machines_like, reached  # noqa: E402
from reconcile.machine.estimated import lines_told  # noqa: E402
from reconcile.machine.force import force_squares  # noqa: E402
from reconcile.machine.laws import LAWS, motions  # noqa: E402
from reconcile.machine.local import around_baseline  # noqa: E402
from reconcile.machine.setting import Setting  # noqa: E402
from reconcile.observe.extract import hann_spectrum, line_powers  # noqa: E402
from reconcile.observe.observation import observe  # noqa: E402
from reconcile.observe.slack import slack  # noqa: E402
from reconcile.observe.watch import bases_at, watch_list  # noqa: E402
from signals.recording import Operating, Recording  # noqa: E402
from signals.series import FloatArray  # noqa: E402
from sim.core.errors import SidebandError  # noqa: E402
from sim.core.response import Channel  # noqa: E402
from sim.core.spec import CustomLaw, MachineSpec, TermSpec  # noqa: E402
from sim.presets import preset  # noqa: E402
from sim.solve.api import simulate  # noqa: E402
from sim.solve.settings import Settings  # noqa: E402

RATE, SETTLED_S, LONG_S = 20000.0, 0.25, 1.2
SETTINGS = Settings(rtol=1e-3, estimate_error=False)
SPEEDS_HZ = (22.5, 30.0, 39.0)
KINDS = ("cubic", "periodic", "drag", "viscous", "dead_zone", "periodic_y", "cubic_y", "rate_free")
LEAST_SHARE = 1e-3
"""Of the strongest line's mean square, from which on a line has any of the force."""
SINES = "{a:.6g}*(cos(2*phi+{p})+0.5*cos(5*phi)+0.6*cos(23*phi+{p})+0.4*sin(46*phi)+0.3*cos(70*phi))"


class Kept(dict[str, bytes], Keeper):
    """The nominal gearbox is simulated once."""

    def put(self, key: str, data: bytes) -> None:
        """Keep it."""
        self[key] = data


@dataclass(frozen=True, kw_only=True)
class Made:
    """A gearbox with its recordings; `force` (axes, n) of each speed is what acted."""

    kind: str
    site: str
    tests: tuple[Recording, ...]
    baselines: tuple[Recording, ...]
    forces: tuple[FloatArray, ...]


@dataclass(frozen=True, kw_only=True)
class Sum:
    """One gearbox at one speed, N rms: what acted at the lines that are told, the estimate and its ends; lines told, of
    these those with none of the force, and how many of the others have it in their bands."""

    true: float
    best: float
    low: float
    high: float
    lines: int
    none: int
    inside: int


def gearbox() -> MachineSpec:
    """As the engine simulates it."""
    return with_tooth_pairs(preset("paper-lightly-damped"))


def _laws(kind: str, machine: MachineSpec, site: str, share: float) -> tuple[list[CustomLaw], list[TermSpec]]:
    motion = motions(machine, [site], 1)[site]
    if kind.startswith("periodic"):
        size = share * motion.stiffness_n_per_m * float(np.std(motion.x))
        formulas = [SINES.format(a=size, p=p) for p in (0.0, 1.3)]
    else:
        law = next(one for one in LAWS if one.key == kind.removesuffix("_y"))
        formulas = [f"{motion.coefficient(law, share):.6g}*{law.formula.format(g=f'{motion.gap_m:.6g}')}"] * 2
    axes = ("y",) if kind.endswith("_y") else ("x", "y")
    named = [
        CustomLaw(name=f"own_{axis}", dof=f"{site}.outer.{axis}", expression=text)
        for axis, text in zip(axes, formulas[-len(axes) :], strict=True)
    ]
    terms = [TermSpec(term="custom_force", site=site, parameters={"law": float(i + 1)}) for i in range(len(named))]
    return named, terms


def _gain(rng: np.random.Generator, count: int) -> FloatArray:
    """Of a sensor over frequency: 6 dB either way, and three ripples over octaves."""
    octaves = np.log2(np.maximum(np.fft.rfftfreq(count, 1.0 / RATE), 1.0) / 1000.0)
    decibels = np.full(octaves.size, rng.uniform(-6.0, 6.0))
    for _ in range(3):
        decibels += rng.normal(0, 2.5) * np.cos(2 * np.pi * octaves / rng.uniform(2, 5) + rng.uniform(0, 6.3))
    return np.asarray(10.0 ** (decibels / 20.0))


def _channel(name: str) -> Channel:
    place = name.partition(".")[0]
    location = place if place.startswith("bearing") else f"bearing{place[-1]}"
    axis = "x" if ".x." in name else "y"
    return Channel(name=name, quantity="acceleration", unit="m/s^2", location=location, axis=axis)


def _heard(machine: MachineSpec, hz: float, wanted: Sequence[str], *, seed: int, slip: int) -> FloatArray:
    """Samples of the channels wanted, settled."""
    here = at_point(machine, Point(speed_hz=hz))
    here = with_effects(here, slips(here, 7, slip))
    found = simulate(
        here, duration_s=SETTLED_S + LONG_S, output_rate_hz=RATE, channels=list(wanted), seed=seed, settings=SETTINGS
    )
    return np.asarray(found.signals)[:, -round(LONG_S * RATE) :]


def made(number: int) -> Made:
    """Gearbox `number`: its own parameters, support, law and sensors."""
    rng, nominal = np.random.default_rng([50, number]), gearbox()
    numbers, channels = uncertain_numbers(nominal), standard_channels(nominal, ())
    offsets = draw_offsets(numbers, rng)
    later = offsets.mixed(draw_offsets(numbers, rng), DRIFT)
    before, after = moved(nominal, numbers, offsets), moved(nominal, numbers, later)
    kind, site = KINDS[(number // 4 + number) % 8], nominal.bearings[number % 4].name
    laws, terms = _laws(kind, after, site, float(rng.choice([0.1, 0.3, 1.0])))
    after = after.model_copy(update={"custom_laws": laws, "terms": terms})
    sensors = [str(one) for one in rng.choice(channels, 3, replace=False)]
    count = round(LONG_S * RATE)
    gains = np.array([_gain(rng, count) for _ in sensors])
    tests: list[Recording] = []
    baselines: list[Recording] = []
    acted = []
    for hz in SPEEDS_HZ:
        wanted = [*sensors, *(f"{site}.custom.{law.name}.force" for law in laws)]
        sound = _heard(before, hz, sensors, seed=11 + number, slip=100 + number)
        found = _heard(after, hz, wanted, seed=911 + number, slip=number)
        acted.append(np.concatenate([np.zeros((2 - len(laws), count)), found[3:]]))
        heard = [np.fft.irfft(np.fft.rfft(one) * gains, count) for one in (sound, found[:3])]
        noise = 0.1 * heard[0].std(axis=1, keepdims=True)
        for kept, one in zip((baselines, tests), heard, strict=True):
            kept.append(
                Recording(
                    sampling_rate_hz=RATE,
                    channels=tuple(map(_channel, sensors)),
                    samples=one + noise * rng.normal(size=one.shape),
                    operating=Operating(shaft="input", speed_hz=hz, torque_nm=25.0),
                )
            )
    return Made(kind=kind, site=site, tests=tuple(tests), baselines=tuple(baselines), forces=tuple(acted))


def setting_of(one: Made, plan: AtlasPlan, keeper: Keeper) -> Setting:
    """What the engine knows of it, its machines around the baseline."""
    nominal = preset("paper-lightly-damped")
    recorded = one.tests[0].channels
    data = observe(nominal, watch_list(nominal), one.tests, one.baselines, seed=0)
    simulated = simulated_channels(nominal, recorded)
    distinct = standard_channels(nominal, simulated)
    banks = [kept_bank(plan, simulated_at(nominal, d.point), distinct, keeper=keeper, mapper=map) for d in data]
    chosen = [bank.at(range(len(plan.draws)), [distinct.index(s) for s in simulated]) for bank in banks]
    seen = lenses(data, chosen, plan)
    setting = Setting(
        machine=nominal, data=data, channels=tuple(c.name for c in recorded), simulated=simulated, plan=plan,
        banks=tuple(chosen), seen_through=seen, changes=observed_changes(data, seen, chosen, plan), seed=0,
    )  # fmt: skip
    local = around_baseline(setting, map)
    return setting if local is None else local.setting


def sums(one: Made, setting: Setting) -> list[Sum]:
    """Of all speeds at which any of the force is at lines that are told."""
    machines, healthy = machines_like(setting), [healthy_of(bank, setting.plan) for bank in setting.banks]
    watched, found = watch_list(setting.machine), []
    for k, (data, force) in enumerate(zip(setting.data, one.forces, strict=True)):
        seen = reached(setting, k, one.site, machines, healthy)
        if seen is None:
            continue
        squares = force_squares(seen.heard)
        _, power, bin_hz = hann_spectrum(force, RATE)
        lines = watched.line_hz(bases_at(setting.machine, data.point.speed_hz))
        acted = line_powers(power, bin_hz, lines, slack(watched.lines, lines), 0.42 * RATE)
        true = np.where(seen.along, np.nan_to_num(acted), 0.0).sum(axis=0)
        asked = lines_told(data, k, seen, squares)
        rows = [int(np.argmin(np.abs(seen.hz - line.frequency_hz))) for line in asked]
        if true[rows].sum() <= 0.0:
            continue
        some = [(line, float(true[i])) for line, i in zip(asked, rows, strict=True) if line.low_n > 0.0]
        real = [(line, square) for line, square in some if square > LEAST_SHARE * true.max()]
        found.append(
            Sum(
                true=float(np.sqrt(true[rows].sum())),
                best=_together([line.force_n for line, _ in some]),
                low=_together([line.low_n for line, _ in some]),
                high=_together([line.high_n for line in asked]),
                lines=len(some),
                none=len(some) - len(real),
                inside=sum(line.low_n**2 <= square <= line.high_n**2 for line, square in real),
            )
        )
    return found


def _together(forces: Sequence[float]) -> float:
    return float(np.sqrt(np.sum(np.square(forces))))


def told(found: Sequence[Sum]) -> str:
    """A few lines for a reader."""
    some = [one for one in found if one.lines]
    ratios = np.percentile([one.best / one.true for one in some], [10, 50, 90]) if some else np.full(3, np.nan)
    held = sum(one.low <= one.true <= one.high for one in some)
    below = sum(one.true <= one.high for one in found)
    lines, none = sum(one.lines for one in some), sum(one.none for one in some)
    inside = sum(one.inside for one in some)
    near = ", ".join(f"{value:.2g}" for value in ratios)
    return (
        f"sums told: {len(some)} of {len(found)}; told over true, 10, 50, 90 %: {near}\n"
        f"true one in the 90 % band: {held} of {len(some)}; below the upper end of all lines: {below} of {len(found)}\n"
        f"single lines told: {lines}; with none of the force {none}; the rest in band: {inside} of {lines - none}"
    )


def main() -> None:
    """Make, look, tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0, help="number of the first gearbox")
    parser.add_argument("--machines", type=int, default=40, help="how many are made (some do not run)")
    given = parser.parse_args()
    nominal = gearbox()
    plan, keeper, found = atlas_plan(nominal, uncertain_numbers(nominal), (), seed=0), Kept(), []
    for number in range(given.first, given.first + given.machines):
        try:
            one = made(number)
        except SidebandError as error:
            print(f"{number}: does not run ({str(error)[:60]})", flush=True)
            continue
        own = sums(one, setting_of(one, plan, keeper))
        found += own
        print(
            f"{number}: {one.kind} at {one.site}: {sum(s.lines > 0 for s in own)} of {len(own)} sums told", flush=True
        )
    print(told(found))


if __name__ == "__main__":
    main()
