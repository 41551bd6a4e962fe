"""A long short-term memory network by JAX, on accelerations or on sequences (its simulations)."""

import numpy as np

from selection import select
from sequences import dense, train

OPTIONS = [{"through": "accelerations", "samples": 60, "penalty": 1e-5, "neurons": 16},
           {"through": "sequences", "samples": 60, "penalty": 1e-6, "neurons": 16},
           {"through": "sequences", "samples": 60, "penalty": 1e-4, "neurons": 16}]


def fit(task):
    inputs = 3 + len(task.controls)

    def fit_option(trials, option):
        random, width = np.random.default_rng(1), option["neurons"]
        weights = [dense(random, inputs + width, 4 * width), dense(random, width + inputs, 3)]
        return train(cell, weights, task, trials, option)
    return select(OPTIONS, fit_option, task.trials)


def cell(xp, weights, memory, rows):
    """Gates of Hochreiter and Schmidhuber (1997) with Gers' forget gate; no memory at first."""
    (gates, offset), (matrix, constant) = weights
    width = gates.shape[1] // 4
    hidden, stored = memory or (xp.zeros((len(rows), width), xp.float32),) * 2
    keep, write, read, value = xp.split(xp.hstack([rows, hidden]) @ gates + offset, 4, axis=1)
    stored = squash(xp, keep + 1) * stored + squash(xp, write) * xp.tanh(value)
    hidden = squash(xp, read) * xp.tanh(stored)
    return (hidden, stored), xp.hstack([hidden, rows]) @ matrix + constant


def squash(xp, value):
    """The logistic function."""
    return 0.5 + 0.5 * xp.tanh(value / 2)
