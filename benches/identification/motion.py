"""Motion from accelerations, smoothed derivatives and regressors: what several peers share."""

import numpy as np

from trials import STATES


def smooth(values, half_width):
    """Values and their differences per sample by a local parabola (Savitzky and Golay 1964)."""
    half = max(1, min(half_width, (len(values) - 1) // 2))
    k = np.arange(-half, half + 1)
    rows = np.linalg.pinv(np.stack([np.ones_like(k), k, k * k], axis=1).astype(float))
    padded = np.concatenate([2 * values[0] - values[half:0:-1], values,
                             2 * values[-1] - values[-2:-half - 2:-1]])
    return np.convolve(padded, rows[0][::-1], "valid"), np.convolve(padded, rows[1][::-1], "valid")


def accelerations(trials, controls, half_width):
    """Smoothed states, controls and accelerations of all trials, without their ends."""
    inputs, outputs = [], []
    for trial in trials:
        pairs = [smooth(trial[name], half_width) for name in STATES]
        state = np.stack([value for value, _ in pairs], axis=1)
        rate = np.stack([slope for _, slope in pairs], axis=1) / trial.dt
        inputs.append(np.hstack([state, trial.columns(controls)])[half_width:-half_width])
        outputs.append(rate[half_width:-half_width])
    return np.concatenate(inputs), np.concatenate(outputs)


class AccelerationModel:
    """Accelerations as a function of rows (u, v, r, controls), integrated by Heun's method."""

    def __init__(self, function, controls, parameters, limit):
        self.function, self.controls = function, controls
        self.parameters, self.limit = parameters, limit

    def simulate(self, windows):
        """States of all windows, in lockstep; each stays where it left the limit."""
        truths = [window.truth for window in windows]
        controls = [truth.columns(self.controls) for truth in truths]
        longest = max(len(truth) for truth in truths)
        held = np.stack([np.pad(c, ((0, longest - len(c)), (0, 0)), "edge") for c in controls])
        state = np.stack([truth.columns(STATES)[0] for truth in truths])
        dt = np.array([[truth.dt] for truth in truths])
        states = [state]
        for k in range(longest - 1):
            state = self.step(state, held[:, k], held[:, k + 1], dt)
            states.append(state)
        states = np.stack(states, axis=1)
        return [dict(zip(STATES, states[i, :len(t)].T)) for i, t in enumerate(truths)]

    def step(self, state, now, then, dt):
        """One step; a state that is not finite or beyond the limit is held at it."""
        first = self.function(np.hstack([state, now]))
        guess = np.clip(np.nan_to_num(state + dt * first), -self.limit, self.limit)
        second = self.function(np.hstack([guess, then]))
        return np.clip(np.nan_to_num(state + dt * (first + second) / 2), -self.limit, self.limit)


def limits(trials):
    """Largest |u|, |v| and |r| of a simulation: three and five times those of the trials."""
    speed = max(np.hypot(trial["u"], trial["v"]).max() for trial in trials)
    turning = max(np.abs(trial["r"]).max() for trial in trials)
    return np.array([3 * speed, 3 * speed, 5 * turning])


def orders(rows, controls):
    """Steering and drive: rudder and revolutions, or difference and mean of both sides."""
    if controls[0] != "delta":
        return rows[:, 3] - rows[:, 4], (rows[:, 3] + rows[:, 4]) / 2
    return rows[:, 3], rows[:, 4] if len(controls) > 1 else np.zeros(len(rows))


class Abkowitz:
    """Regressors of (u, v, r, steering, drive) to the third order, states by their scale."""

    def __init__(self, rows, controls):
        self.controls = controls
        state = self.states(rows)
        self.mean = np.array([state[:, 0].mean(), 0, 0, 0, state[:, 4].mean()])
        self.scale = np.maximum(np.abs(state - self.mean).max(axis=0), 1e-6)

    def states(self, rows):
        """Speeds, steering and drive, one column each."""
        return np.column_stack([rows[:, :3], *orders(rows, self.controls)])

    def __call__(self, rows):
        state = (self.states(rows) - self.mean) / self.scale
        u, v, r, d, n = state.T
        one = np.ones_like(u)
        return np.stack([
            one, u, u * u, u**3, n, n * abs(n), u * n,
            v, r, d, v * abs(v), r * abs(r), d * abs(d), v * abs(r), r * abs(v),
            v * v, r * r, d * d, v * r, v * d, r * d, v**3, r**3, d**3,
            v * v * r, v * r * r, v * v * d, r * r * d, v * d * d, r * d * d,
            u * v, u * r, u * d, n * d, u * v * r, u * d * d, n * v, n * r], axis=1)
