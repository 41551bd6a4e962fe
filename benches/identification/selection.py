"""Choice of a peer's settings by its own training trials."""

import numpy as np

from motion import limits
from scores import score
from trials import Window


def folds(trials, most=3):
    """Pairs of fitted trials and held-out windows: whole trials, or the end of a single one."""
    if len(trials) == 1:
        cut = int(0.7 * len(trials[0]))
        return [([trials[0].part(0, cut)], [Window(trials[0], cut, len(trials[0]))])]
    picked = sorted({round(k) for k in np.linspace(0, len(trials) - 1, min(most, len(trials)))})
    return [([t for j, t in enumerate(trials) if j != k], [Window(trials[k], 0, len(trials[k]))])
            for k in picked]


def select(options, fit, trials):
    """Fits each option without held-out trials, and the one with the least error on all."""
    limit = limits(trials)
    best = min(options, key=lambda option: held_out_error(option, fit, trials, limit))
    model = fit(trials, best)
    model.settings = best
    return model


def held_out_error(option, fit, trials, limit):
    total = 0.0
    for fitted, windows in folds(trials):
        try:
            predictions = fit(fitted, option).simulate(windows)
        except (np.linalg.LinAlgError, ValueError):
            return np.inf
        total += score(windows, predictions, limit)["standardised_error"]
    return total
