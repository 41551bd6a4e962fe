"""Ridge on Abkowitz regressors by NumPy alone, for machines without scikit-learn."""

import numpy as np

from motion import Abkowitz, AccelerationModel, accelerations, limits
from selection import select

OPTIONS = [(width, strength) for width in (2, 5) for strength in (1e-5, 1e-3, 1e-1)]


def fit(task):
    def fit_option(trials, option):
        width, strength = option
        rows, rates = accelerations(trials, task.controls, width)
        terms = Abkowitz(rows, task.controls)
        matrix = terms(rows)
        scale = np.maximum(np.sqrt((matrix**2).mean(axis=0)), 1e-9)
        matrix = matrix / scale
        normal = matrix.T @ matrix + strength * len(matrix) * np.eye(matrix.shape[1])
        weights = np.linalg.solve(normal, matrix.T @ rates) / scale[:, None]
        return AccelerationModel(lambda rows: terms(rows) @ weights, task.controls,
                                 weights.size, limits(trials))
    return select(OPTIONS, fit_option, task.trials)
