"""scikit-learn's multilayer perceptron on accelerations."""

import warnings

import numpy as np
from sklearn.neural_network import MLPRegressor

from motion import AccelerationModel, accelerations, limits
from selection import select

# Half width of the derivative filter, neurons of each of two layers, l2 penalty.
OPTIONS = [(width, neurons, penalty) for width in (3, 6) for neurons in (16, 48)
           for penalty in (1e-3, 1e-1)]


def fit(task):
    def fit_option(trials, option):
        width, neurons, penalty = option
        rows, rates = accelerations(trials, task.controls, width)
        mean, scale = rows.mean(axis=0), np.maximum(rows.std(axis=0), 1e-9)
        spread = np.maximum(rates.std(axis=0), 1e-12)
        network = MLPRegressor(hidden_layer_sizes=(neurons, neurons), activation="tanh",
                               alpha=penalty, max_iter=300, early_stopping=True, random_state=1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            network.fit((rows - mean) / scale, rates / spread)
        count = sum(w.size for w in network.coefs_ + network.intercepts_)
        return AccelerationModel(lambda rows: network.predict((rows - mean) / scale) * spread,
                                 task.controls, count, limits(trials))
    return select(OPTIONS, fit_option, task.trials)
