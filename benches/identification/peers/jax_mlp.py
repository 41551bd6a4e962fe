"""A multilayer perceptron by JAX, on accelerations or on sequences (its simulations)."""

import numpy as np

from selection import select
from sequences import dense, train

OPTIONS = [{"through": "accelerations", "samples": 40, "penalty": 1e-5, "neurons": 32},
           {"through": "sequences", "samples": 40, "penalty": 1e-6, "neurons": 32},
           {"through": "sequences", "samples": 40, "penalty": 1e-4, "neurons": 32}]


def fit(task):
    inputs = 3 + len(task.controls)

    def fit_option(trials, option):
        random, width = np.random.default_rng(1), option["neurons"]
        weights = [dense(random, inputs, width), dense(random, width, width),
                   dense(random, width, 3)]
        return train(cell, weights, task, trials, option)
    return select(OPTIONS, fit_option, task.trials)


def cell(xp, weights, memory, rows):
    """Two hidden layers without memory."""
    for matrix, offset in weights[:-1]:
        rows = xp.tanh(rows @ matrix + offset)
    matrix, offset = weights[-1]
    return rows[:, :0], rows @ matrix + offset
