"""Networks trained through time by JAX: what the peers `jax_mlp` and `jax_lstm` share.

A cell maps (parameters, memory, scaled states and controls) to (memory, scaled accelerations).
Trained on accelerations it is given the measured states; on sequences, which follow, it is given
its own from the first state of a piece on.
"""

import jax
import jax.numpy as jnp
import numpy as np
import optax

from motion import AccelerationModel, accelerations, limits
from trials import STATES

BATCH = 32
# Steps of the optimiser and its first rate.
PHASES = {"accelerations": (600, 5e-3), "sequences": (600, 1e-3)}


class SequenceModel(AccelerationModel):
    """A cell that is simulated by Euler steps, as it was trained."""

    def __init__(self, cell, weights, scaling, task, limit):
        count = sum(np.size(weight) for weight in jax.tree_util.tree_leaves(weights))
        super().__init__(None, task.controls, count, limit)
        self.cell, self.weights, self.scaling, self.memory = cell, weights, scaling, None

    def simulate(self, windows):
        self.memory = None
        return super().simulate(windows)

    def step(self, state, now, then, dt):
        mean, spread, rate_spread = self.scaling
        rows = (np.hstack([state, now]) - mean) / spread
        self.memory, rates = self.cell(np, self.weights, self.memory, rows)
        return np.clip(np.nan_to_num(state + dt * rate_spread * rates), -self.limit, self.limit)


def train(cell, weights, task, trials, option):
    """Adam on random pieces; `option` has `through`, `samples` of a piece and `penalty`."""
    rows, rates = accelerations(trials, task.controls, 3)
    scaling = (rows.mean(axis=0), np.maximum(rows.std(axis=0), 1e-6),
               np.maximum(rates.std(axis=0), 1e-12))
    pieces = Pieces(trials, task.controls, option["samples"])
    for through in ("accelerations", "sequences"):
        misfit = misfits(cell, scaling, trials[0].dt)[through]
        weights = descend(misfit, weights, pieces, (*PHASES[through], option["penalty"]))
        if through == option["through"]:
            break
    weights = jax.tree_util.tree_map(np.asarray, weights)
    return SequenceModel(cell, weights, scaling, task, limits(trials))


def descend(misfit, weights, pieces, settings):
    """Adam with gradients of at most unit length and a rate that falls to zero."""
    steps, rate, penalty = settings
    optimiser = optax.chain(optax.clip_by_global_norm(1.0),
                            optax.adam(optax.cosine_decay_schedule(rate, steps)))

    def loss(weights, rows, rates):
        squares = sum(jnp.sum(w * w) for w in jax.tree_util.tree_leaves(weights))
        return misfit(weights, rows, rates) + penalty * squares

    @jax.jit
    def advance(weights, state, rows, rates):
        changes, state = optimiser.update(jax.grad(loss)(weights, rows, rates), state)
        return optax.apply_updates(weights, changes), state
    state = optimiser.init(weights)
    for _ in range(steps):
        weights, state = advance(weights, state, *pieces.draw())
    return weights


class Pieces:
    """Random pieces of equal length: smoothed states and controls, and accelerations."""

    def __init__(self, trials, controls, samples):
        each = [accelerations([trial], controls, 3) for trial in trials]
        self.samples = min([samples] + [len(rows) for rows, _ in each])
        self.each = each
        self.share = np.array([len(rows) - self.samples + 1 for rows, _ in each], float)
        self.random = np.random.default_rng(1)

    def draw(self):
        chosen = self.random.choice(len(self.each), BATCH, p=self.share / self.share.sum())
        starts = [self.random.integers(int(self.share[k])) for k in chosen]
        cut = lambda part: np.stack([self.each[k][part][i:i + self.samples]
                                     for k, i in zip(chosen, starts)], axis=1).astype(np.float32)
        return cut(0), cut(1)


def misfits(cell, scaling, dt):
    """Mean squares over a batch of pieces, time along the first axis, of both ways to train."""
    mean, spread, rate_spread = (jnp.asarray(value, jnp.float32) for value in scaling)
    states = len(STATES)

    def given(weights, rows, rates):
        def advance(memory, row):
            return cell(jnp, weights, memory, (row - mean) / spread)
        first, _ = advance(None, rows[0])
        start = jax.tree_util.tree_map(jnp.zeros_like, first)
        _, found = jax.lax.scan(advance, start, rows)
        return jnp.mean((found - rates / rate_spread)**2)

    def free(weights, rows, _):
        def advance(carry, row):
            memory, state = carry
            scaled = (jnp.concatenate([state, row[:, states:]], axis=1) - mean) / spread
            memory, rates = cell(jnp, weights, memory, scaled)
            bound = 5 * jnp.abs(mean[:states]) + 10 * spread[:states]
            state = jnp.clip(state + dt * rate_spread * rates, -bound, bound)
            return (memory, state), state
        first, _ = cell(jnp, weights, None, rows[0])
        start = jax.tree_util.tree_map(jnp.zeros_like, first)
        _, found = jax.lax.scan(advance, (start, rows[0, :, :states]), rows[:-1])
        return jnp.mean(((found - rows[1:, :, :states]) / spread[:states])**2)

    return {"accelerations": given, "sequences": free}


def dense(random, rows, columns):
    """Weights of a layer and its offsets, by Glorot's rule."""
    width = np.sqrt(6 / (rows + columns))
    return (random.uniform(-width, width, (rows, columns)).astype(np.float32),
            np.zeros(columns, np.float32))
