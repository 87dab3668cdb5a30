"""Force in, motion out: all steps from the parts of the recordings to what is judged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.driven.forced import ALPHA, Analysis, calibrate
from reconcile.driven.judge import ROUGH
from reconcile.driven.latent import latent_force
from reconcile.driven.measured import Look
from reconcile.driven.missing import anything_missing
from reconcile.driven.model import bounded, errors, nrmse, ready, simulated
from reconcile.driven.noise import noise_of
from reconcile.driven.nominate import free_power, nominate
from reconcile.driven.settle import Case, Settled, renominated, sensitive, settle
from reconcile.driven.split import Part, order_of_use
from reconcile.force_law.exponent import odd_exponent
from reconcile.force_law.search import search


def analyse(parts: Sequence[Part], seed: int, rested: Sequence[Look] = ()) -> Analysis:
    """All steps; the parts are recordings or consecutive stretches of one. `rested`: the baselines' linear models."""
    rng = np.random.default_rng([seed, 1])
    fit_part, held_part = order_of_use(parts)
    start = calibrate(fit_part)
    run, linear = start.run, start.linear
    missing = anything_missing(linear.model, run, linear.error, rng)
    latent = latent_force(linear.model, run, linear.error)
    found = search(latent)
    exponent = odd_exponent(latent, rng)
    nominated = nominate(linear, found, latent, run, start.other) if missing.p_value < ALPHA else None
    held = ready(held_part.data, linear.model.memory_s)
    settled = Settled(final=linear, validations=())
    if nominated is not None and nominated.chosen.laws:
        case = Case(parts=parts, start=start, held=held, names=(fit_part.name, held_part.name), seed=seed)
        settled = settle(case, nominated.chosen.fitted.model)
        nominated = renominated(nominated, settled, case)
    final = settled.final
    laws = final.model.laws
    noise = noise_of(final.model, run, errors(final.model, run), rested)
    return Analysis(
        linear=linear,
        fitted_nrmse=nrmse(linear.error, run.compared),
        missing=missing,
        left=anything_missing(final.model, run, errors(final.model, run), rng) if laws else None,
        latent=latent,
        found=found,
        exponent=exponent,
        nominated=nominated,
        final=final,
        power=free_power(linear.model, final.model, run, start.other) if laws else None,
        validations=settled.validations,
        fitted_run=run,
        held_run=held,
        held_before=simulated(linear.model, held),
        held_after=bounded(simulated(final.model, held), held),
        beyond_noise=noise.unexplained if laws else 0.0,
        unsure=bool(laws and settled.validations) and settled.validations[0].after >= ROUGH and sensitive(final, held),
        laws_leave=noise.left if laws else 0.0,
        dropped=settled.dropped,
    )
