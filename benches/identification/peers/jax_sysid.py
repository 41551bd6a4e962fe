"""jax-sysid (Bemporad 2024): a residual state-space network of (u, v, r), trained on whole
trials by Adam and L-BFGS with its own loss."""

import contextlib
import io

import numpy as np
from jax_sysid.models import Model

import jax.numpy as jnp
from motion import AccelerationModel, limits
from selection import select
from trials import STATES

# Neurons (none: a linear model) and the penalty on the weights.
OPTIONS = [(0, 1e-3), (8, 1e-4), (8, 1e-2)]
SAMPLES = 300


def fit(task):
    def fit_option(trials, option):
        neurons, penalty = option
        pieces = [trial.part(k, k + SAMPLES) for trial in trials
                  for k in range(0, max(1, len(trial) - SAMPLES // 2), SAMPLES)]
        pieces = pieces[::-(-len(pieces) // 12)]
        rows = np.concatenate([piece.columns((*STATES, *task.controls)) for piece in pieces])
        mean, spread = rows.mean(axis=0), np.maximum(rows.std(axis=0), 1e-6)
        scaled = [(p.columns((*STATES, *task.controls)) - mean) / spread for p in pieces]
        model = Model(3, 3, len(task.controls), state_fcn=following, y_in_x=True)
        model.init(weights(neurons, len(task.controls)), x0=[piece[0, :3] for piece in scaled])
        model.loss(rho_x0=0.0, rho_th=penalty)
        model.optimization(adam_epochs=300, lbfgs_epochs=300, iprint=-1)
        with contextlib.redirect_stdout(io.StringIO()):
            model.fit([piece[:, :3] for piece in scaled], [piece[:, 3:] for piece in scaled])
        found = [np.asarray(value) for value in model.params]
        return Recursion(found, (mean, spread), task, limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def weights(neurons, controls):
    """First weights: a slow linear part and a small network."""
    random = np.random.default_rng(1)
    draw = lambda *shape: 0.1 * random.standard_normal(shape)
    linear = [-0.02 * np.eye(3), 0.1 * draw(3, controls), np.zeros(3)]
    return linear + ([draw(neurons, 3 + controls), np.zeros(neurons), 0.1 * draw(3, neurons)]
                     if neurons else [])


def following(state, control, params, xp=jnp):
    """The state one sample later, all of it scaled."""
    matrix, steering, offset, *network = params
    change = matrix @ state + steering @ control + offset
    if network:
        inner, constant, outer = network
        change = change + outer @ xp.tanh((inner @ xp.concatenate([state, control])).T + constant).T
    return state + change


class Recursion(AccelerationModel):
    """The recursion, one sample a step."""

    def __init__(self, params, scaling, task, limit):
        super().__init__(None, task.controls, sum(value.size for value in params), limit)
        self.params, self.scaling = params, scaling

    def step(self, state, now, then, dt):
        mean, spread = self.scaling
        rows = (np.hstack([state, now]) - mean) / spread
        found = following(rows[:, :3].T, rows[:, 3:].T, self.columns(), np).T
        return np.clip(np.nan_to_num(found * spread[:3] + mean[:3]), -self.limit, self.limit)

    def columns(self):
        """Parameters whose offset of the linear part is a column, for many states at once."""
        matrix, steering, offset, *network = self.params
        return [matrix, steering, offset[:, None], *network]
