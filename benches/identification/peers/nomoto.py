"""First-order Nomoto equation with a speed equation: the floor. NumPy alone."""

import numpy as np

from motion import AccelerationModel, accelerations, limits, orders
from selection import select



def fit(task):
    def fit_width(trials, half_width):
        rows, rates = accelerations(trials, task.controls, half_width)
        terms = lambda rows: regressors(rows, task.controls)
        solve = lambda a, b: np.linalg.lstsq(a, b, rcond=None)[0]
        surge, yaw = (solve(a, b) for a, b in zip(terms(rows), (rates[:, 0], rates[:, 2])))
        drift = rows[:, 2] @ rows[:, 1] / max(rows[:, 2] @ rows[:, 2], 1e-12)

        def function(rows):
            x, n = terms(rows)
            rate = n @ yaw
            return np.stack([x @ surge, drift * rate, rate], axis=1)
        count = len(surge) + len(yaw) + 1
        return AccelerationModel(function, task.controls, count, limits(trials))
    return select((2, 5), fit_width, task.trials)


def regressors(rows, controls):
    """Terms of surge (resistance, thrust, loss in turns) and of yaw (Nomoto 1957)."""
    u, _, r = rows[:, :3].T
    steering, drive = orders(rows, controls)
    one = np.ones_like(u)
    return (np.stack([one, u * abs(u), drive * abs(drive), r * r], axis=1),
            np.stack([one, r, steering], axis=1))
