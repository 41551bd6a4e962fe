"""pysindy: sparse polynomials of states and controls by sequential thresholding."""

import warnings

import numpy as np
import pysindy

from motion import AccelerationModel, accelerations, limits
from selection import select

OPTIONS = [(degree, width, threshold) for degree in (2, 3) for width in (2, 5)
           for threshold in (0.003, 0.03)]


def fit(task):
    def fit_option(trials, option):
        degree, width, threshold = option
        rows, rates = accelerations(trials, task.controls, width)
        scale = np.maximum(np.abs(rows).max(axis=0), 1e-9)
        rows, spread = rows / scale, np.maximum(rates.std(axis=0), 1e-12)
        states = len(rates[0])
        model = pysindy.SINDy(
            optimizer=pysindy.STLSQ(threshold=threshold, alpha=1e-4, max_iter=50),
            feature_library=pysindy.PolynomialLibrary(degree=degree))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model.fit(rows[:, :states], t=trials[0].dt, x_dot=rates / spread, u=rows[:, states:])

        weights = model.coefficients()

        def function(given):
            given = given / scale
            return (features(model, given) @ weights.T) * spread
        return AccelerationModel(function, task.controls, int(np.count_nonzero(weights)),
                                 limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def features(model, rows):
    """Terms of the library for rows of states and controls, in its own order."""
    powers = model.feature_library.powers_
    return np.prod(rows[:, None, :]**powers, axis=2)
