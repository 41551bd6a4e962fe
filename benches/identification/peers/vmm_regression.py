"""VesselManoeuvringModels (Alexandersson, Mao and Ringsberg 2022): inverse dynamics, that is,
ordinary least squares of a vessel manoeuvring model in the prime system on accelerations.

Thrust is given as the square of the revolutions, whose factor the regression finds.
"""

import importlib
import warnings

import numpy as np
import pandas as pd
from vessel_manoeuvring_models.models.regression import MotionRegression
from vessel_manoeuvring_models.parameters import df_parameters
from vessel_manoeuvring_models.substitute_dynamic_symbols import run

from job import CannotDo
from motion import AccelerationModel, accelerations, limits
from selection import select

RHO = 1000.0
# Half width of the derivative filter and the library's model, from few to many coefficients.
OPTIONS = [(4, "vmm_martin_simple"), (4, "vmm_martin"), (8, "vmm_martin"), (4, "vmm_abkowitz")]
ADDED = ("Xudot", "Yvdot", "Yrdot", "Nvdot", "Nrdot")


def fit(task):
    frame = frame_of(task)

    def fit_option(trials, option):
        width, name = option
        rows, rates = accelerations(trials, task.controls, width)
        return frame.model(frame.regress(name, rows, rates), limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def frame_of(task):
    if task.controls[0] != "delta":
        raise CannotDo("the library's models have a rudder, the ship has none")
    return Frame(task)


class Frame:
    """Particulars, added masses by Brix and Clarke, and regressions in the library's columns."""

    def __init__(self, task):
        given = task.ship.particulars
        length, beam, draught = given["lpp_m"], given["beam_m"], given["draught_m"]
        volume = given.get("displacement_m3", given.get("mass_kg", 0.0) / RHO) or (
            given.get("block_coefficient", 0.65) * length * beam * draught)
        self.controls = task.controls
        self.ship = {"L": length, "B": beam, "T": draught, "rho": RHO, "volume": volume,
                     "CB": volume / (length * beam * draught), "m": RHO * volume,
                     "I_z": RHO * volume * (0.25 * length)**2, "x_G": given.get("x_g_m", 0.0)}
        found = df_parameters.loc[list(ADDED), "brix_lambda"]
        self.added = {name: float(run(brix, **self.ship)) for name, brix in found.items()}
        speeds = np.concatenate([np.hypot(trial["u"], trial["v"]) for trial in task.trials])
        self.least = 0.05 * np.median(speeds)

    def thrust(self, rows):
        """The square of the revolutions; constant where they are not recorded."""
        drive = rows[:, 4] * abs(rows[:, 4]) if len(self.controls) > 1 else np.ones(len(rows))
        return drive * 0.01 * RHO * self.ship["L"]**2

    def data(self, rows, rates):
        """The library's table; its prime system divides by the speed, so rows at rest are out."""
        names = ("u", "v", "r", "delta", "thrust", "u1d", "v1d", "r1d")
        columns = (*rows[:, :4].T, self.thrust(rows), *rates.T)
        table = pd.DataFrame(dict(zip(names, columns)))
        return table[np.hypot(table.u, table.v) > 4 * self.least].reset_index(drop=True)

    def regress(self, name, rows, rates):
        module = importlib.import_module(f"vessel_manoeuvring_models.models.{name}")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return MotionRegression(module, self.data(rows, rates), self.added, self.ship)

    def model(self, regression, bound):
        length = self.ship["L"]
        axes = [Axis(equation, fitted.params) for equation, fitted in
                ((regression.diff_eq_X, regression.model_X),
                 (regression.diff_eq_Y, regression.model_Y),
                 (regression.diff_eq_N, regression.model_N))]

        def function(rows):
            speed = np.maximum(np.hypot(rows[:, 0], rows[:, 1]), self.least)
            force = 0.5 * RHO * (length * speed)**2
            primes = {"u": rows[:, 0] / speed, "v": rows[:, 1] / speed,
                      "r": rows[:, 2] * length / speed, "delta": rows[:, 3],
                      "thrust": self.thrust(rows) / force}
            return (np.stack([axis(primes) for axis in axes], axis=1)
                    * (speed**2 / length)[:, None] / [1, 1, length])
        count = sum(len(axis.weights) for axis in axes)
        return AccelerationModel(function, self.controls, count, bound)


class Axis:
    """An acceleration: features of the library's equation by the coefficients it has fitted."""

    def __init__(self, equation, weights):
        self.features = equation.X_lambda
        names = list(equation.feature_names_subs().values())
        self.constant = 1 in equation.eq_X.rhs
        self.weights = weights[names].to_numpy()

    def __call__(self, primes):
        features = np.asarray(run(self.features, **primes)).reshape(-1, len(primes["u"]))
        rest = self.weights[1:] if self.constant else self.weights
        return rest @ features + (self.weights[0] if self.constant else 0.0)
