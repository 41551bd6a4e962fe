"""SciPy's least squares on simulated trajectories of an MMG-like model (Yasukawa and Yoshimura
2015): hull derivatives to the third order, thrust by revolutions, rudder in the slipstream.

Forces by 0.5 rho L T U^2 and L; parameters start at typical values with weak Gaussian priors.
"""

import numpy as np
from scipy.optimize import least_squares

from job import CannotDo
from motion import AccelerationModel, limits
from selection import select
from trials import STATES, Window

# Mean of each parameter. The first three are added masses and inertia, the last six propulsion.
PRIORS = {"mx": 0.02, "my": 0.22, "jz": 0.02, "x0": 0.022, "xvv": -0.04, "xvr": 0.0, "xrr": 0.01,
          "yv": -0.315, "yr": 0.08, "yvvv": -1.6, "yvvr": 0.38, "yvrr": -0.39, "yrrr": 0.008,
          "nv": -0.14, "nr": -0.05, "nvvv": -0.03, "nvvr": -0.29, "nvrr": 0.055, "nrrr": -0.013,
          "y0": 0.0, "n0": 0.0, "thrust": 1.0, "advance": 0.5, "wash": 0.5, "rudder": 0.05,
          "flow": 0.5, "lever": -0.7, "drag": 0.6}
WIDTH = {"y0": 0.003, "n0": 0.002, "xvv": 0.1, "xvr": 0.1, "yvrr": 0.5, "yrrr": 0.1, "nvvv": 0.3}
NAMES = tuple(PRIORS)
MEAN = np.array(list(PRIORS.values()))
SCALE = np.array([WIDTH.get(name, max(0.5 * abs(mean), 0.02)) for name, mean in PRIORS.items()])


def fit(task):
    if task.controls[0] != "delta":
        raise CannotDo("the model has a rudder or a thruster that turns, the ship has neither")
    ship = task.ship.particulars
    block = ship.get("block_coefficient", 0.65)
    mass = 2 * block * ship["beam_m"] / ship["lpp_m"]
    speed = np.median(np.concatenate([trial["u"] for trial in task.trials]))
    turning = np.median(np.concatenate([revolutions(t) for t in task.trials]))
    frame = (ship["lpp_m"], mass, max(speed, 1e-3), turning if abs(turning) > 1e-6 else 1.0)

    def fit_strength(trials, strength):
        pieces = segments(trials, 8 * frame[0] / frame[2])
        spread = np.concatenate([p.truth.columns(STATES) for p in pieces]).std(axis=0) + 1e-9
        bound = limits(trials)

        def residuals(z):
            return misses(z[None], strength)[0]

        def slopes(z):
            moved = np.vstack([z, z + 1e-4 * np.eye(len(z))])
            found = misses(moved, strength)
            return (found[1:] - found[0]).T / 1e-4

        def misses(z, strength):
            """One row per parameter set; all of them are simulated in lockstep."""
            values = np.repeat(MEAN + SCALE * z, len(pieces), axis=0).T
            runs = model(values, frame, task.controls, bound).simulate(pieces * len(z))
            states = np.stack([[run[s] for s in STATES] for run in runs])
            truth = np.stack([[p.truth[s] for s in STATES] for p in pieces])
            missed = (states.reshape(len(z), *truth.shape) - truth) / spread[:, None]
            missed = missed.reshape(len(z), -1)
            return np.hstack([missed, z * strength * np.sqrt(missed.shape[1]) / 30])
        found = least_squares(residuals, np.zeros(len(MEAN)), slopes, loss="soft_l1", max_nfev=12,
                              bounds=(-8, 8))
        return model(MEAN + SCALE * found.x, frame, task.controls, bound)
    return select((0.1, 1.0), fit_strength, task.trials)


def revolutions(trial):
    return trial["n"] if "n" in trial.channels else np.ones(len(trial))


def segments(trials, seconds):
    """At most thirty pieces of the trials of one length, evenly chosen."""
    every = []
    for trial in trials:
        step = min(max(10, round(seconds / trial.dt)), min(map(len, trials)))
        every += [Window(trial, k, k + step) for k in range(0, len(trial) - step + 1, step)]
    return every[::-(-len(every) // 30)]


def model(values, frame, controls, bound):
    p = dict(zip(NAMES, values))
    length, mass, speed, turning = frame

    def function(rows):
        u, v, r, delta = rows[:, :4].T
        k = rows[:, 4] / turning if len(controls) > 1 else np.ones(len(rows))
        flow = np.sqrt(u * u + v * v + (0.05 * speed)**2)
        a, b, c = u / flow, v / flow, r * length / flow
        thrust = p["x0"] * (p["thrust"] * k * abs(k) * (1 + p["advance"])
                            - p["advance"] * k * u / speed) * (speed / flow)**2
        wash = (1 - p["wash"]) * a * abs(a) + p["wash"] * k * abs(k) * (speed / flow)**2
        rudder = p["rudder"] * wash * np.sin(delta + p["flow"] * np.arctan2(b + p["lever"] * c,
                                                                           np.abs(a) + 0.1))
        x = (thrust - p["x0"] * a * abs(a) + p["xvv"] * b * b + p["xvr"] * b * c
             + p["xrr"] * c * c - p["drag"] * rudder * np.sin(delta))
        y = (p["y0"] + p["yv"] * b + p["yr"] * c + p["yvvv"] * b**3 + p["yvvr"] * b * b * c
             + p["yvrr"] * b * c * c + p["yrrr"] * c**3 - rudder)
        n = (p["n0"] + p["nv"] * b + p["nr"] * c + p["nvvv"] * b**3 + p["nvvr"] * b * b * c
             + p["nvrr"] * b * c * c + p["nrrr"] * c**3 + 0.5 * rudder)
        scale = flow * flow / length
        return np.stack([(x * scale + (mass + p["my"]) * v * r) / (mass + abs(p["mx"])),
                         (y * scale - (mass + p["mx"]) * u * r) / (mass + abs(p["my"])),
                         n * scale / length / (mass / 16 + abs(p["jz"]))], axis=1)
    return AccelerationModel(function, controls, len(values), bound)
