"""scikit-learn's Gaussian process on accelerations, one kernel of separate lengths per axis."""

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from motion import AccelerationModel, accelerations, limits
from selection import select

# Half width of the derivative filter and number of rows that the process is conditioned on.
OPTIONS = [(3, 200), (6, 200), (6, 400)]


def fit(task):
    def fit_option(trials, option):
        width, count = option
        rows, rates = accelerations(trials, task.controls, width)
        picked = np.random.default_rng(1).permutation(len(rows))[:count]
        mean, scale = rows.mean(axis=0), np.maximum(rows.std(axis=0), 1e-9)
        spread = np.maximum(rates.std(axis=0), 1e-12)
        given = (rows[picked] - mean) / scale
        axes = [process(given, rates[picked, k] / spread[k]) for k in range(3)]

        def function(rows):
            given = (rows - mean) / scale
            return np.stack([axis.predict(given) for axis in axes], axis=1) * spread
        return AccelerationModel(function, task.controls, 3 * len(picked), limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def process(given, target):
    kernel = ConstantKernel(1.0) * RBF(np.ones(given.shape[1])) + WhiteKernel(0.1)
    return GaussianProcessRegressor(kernel, normalize_y=True, random_state=1).fit(given, target)
