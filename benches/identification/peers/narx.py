"""sysidentpy: polynomial NARX by FROLS, one model per state, simulated together."""

import warnings

import numpy as np
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import RidgeRegression

from motion import limits
from selection import select
from trials import STATES

# Degree of the polynomial and number of terms of each state.
OPTIONS = [(1, 6), (2, 8), (2, 14), (3, 12)]
LAGS = 2


def fit(task):
    def fit_option(trials, option):
        degree, terms = option
        names = (*STATES, *task.controls)
        scale = np.maximum(np.abs(np.concatenate([t.columns(names) for t in trials])).max(0), 1e-9)
        # Trials follow each other in one record; few of its rows span two of them.
        record = np.concatenate([t.columns(names) for t in trials]) / scale
        models = [identify(record, k, degree, terms) for k in range(3)]
        return Narx(models, scale, names, limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def identify(record, k, degree, terms):
    """Columns of regressors and their coefficients for the state in column k."""
    others = np.delete(record, k, axis=1)
    model = FROLS(order_selection=False, n_terms=terms, ylag=LAGS,
                  xlag=[list(range(1, LAGS + 1))] * others.shape[1],
                  estimator=RidgeRegression(alpha=1e-6), basis_function=Polynomial(degree=degree))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model.fit(X=others, y=record[:, [k]])
    columns = [k] + [j for j in range(record.shape[1]) if j != k]
    codes = [[(columns[code // 1000 - 1], code % 1000) for code in row if code]
             for row in model.final_model]
    return codes, model.theta.ravel()


class Narx:
    """A recursion over all states; the samples before a window give its first lags."""

    def __init__(self, models, scale, names, limit):
        self.models, self.scale, self.names, self.limit = models, scale, names, limit
        self.parameters = sum(len(theta) for _, theta in models)

    def simulate(self, windows):
        return [self.run(window) for window in windows]

    def run(self, window):
        rows = window.truth.columns(self.names) / self.scale
        before = window.before.columns(self.names)[-LAGS + 1:] / self.scale
        lead = before if len(before) else np.repeat(rows[:1], LAGS - 1, axis=0)
        rows = np.concatenate([lead, rows])
        bound = self.limit / self.scale[:3]
        for k in range(len(lead) + 1, len(rows)):
            following = [sum(weight * np.prod([rows[k - lag, c] for c, lag in factors])
                             for factors, weight in zip(codes, theta))
                         for codes, theta in self.models]
            rows[k, :3] = np.clip(np.nan_to_num(following), -bound, bound)
        return dict(zip(STATES, (rows[len(lead):, :3] * self.scale[:3]).T))
