"""VesselManoeuvringModels: extended Kalman filter and smoother about a regressed model, then the
regression again on the smoothed states (Alexandersson, Mao and Ringsberg 2022)."""

import importlib
import warnings

import numpy as np
import pandas as pd
from vessel_manoeuvring_models.extended_kalman_vmm import ExtendedKalman, SystemMatrixes

from job import CannotDo
from motion import accelerations, limits, smooth
from peers.vmm_regression import frame_of
from selection import select
from trials import PLACE, STATES

# Library's model, and standard deviation of accelerations by that of the trials.
OPTIONS = [("vmm_martin_simple", 0.1), ("vmm_martin_simple", 1.0)]
# The simplest model filters: the others' Jacobians take minutes to derive.
FILTER = "vmm_martin_simple"


def fit(task):
    if any(name not in task.trials[0].measured for name in PLACE):
        raise CannotDo("the filter observes position and heading, which are not measured")
    frame = frame_of(task)
    matrixes = SystemMatrixes(importlib.import_module(f"vessel_manoeuvring_models.models.{FILTER}"))

    def fit_option(trials, option):
        name, share = option
        rows, rates = accelerations(trials, task.controls, 4)
        first = frame.regress(FILTER, rows, rates)
        kalman = filter_of(frame, first, matrixes)
        parts = [smoothed(kalman, frame, trial, task.controls, share * rates.std(axis=0))
                 for trial in trials]
        rows, rates = (np.concatenate(part) for part in zip(*parts))
        good = np.isfinite(rows).all(axis=1) & np.isfinite(rates).all(axis=1)
        if good.sum() < 100:
            raise ValueError("the filter diverged")
        return frame.model(frame.regress(name, rows[good], rates[good]), limits(trials))
    return select(OPTIONS, fit_option, task.trials)


def filter_of(frame, regression, matrixes):
    """The library's filter with the coefficients of a regression."""
    found = {**frame.added, **regression.parameters["regressed"]}
    module = importlib.import_module(f"vessel_manoeuvring_models.models.{FILTER}")
    return ExtendedKalman(module, found, frame.ship, matrixes)


def smoothed(kalman, frame, trial, controls, deviation):
    """States and accelerations of a trial by filter and smoother."""
    columns = dict(zip(("x0", "y0", "psi", "u", "v", "r"),
                       trial.columns((*PLACE[1:], "psi", *STATES)).T))
    rows = trial.columns((*STATES, *controls))
    columns |= {"delta": rows[:, 3], "thrust": frame.thrust(rows)}
    data = pd.DataFrame(columns, index=trial["t"])
    scatter = np.array([np.std(trial[name] - smooth(trial[name], 4)[0])
                        for name in ("x", "y", "psi")])
    observed, hidden = np.eye(3, 6), np.vstack([np.zeros((3, 3)), np.eye(3)])
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        kalman.filter(data, P_prd=np.diag([*scatter**2, *(10 * deviation * trial.dt)**2]),
                      Qd=np.diag(deviation**2), Rd=np.diag(np.maximum(scatter, 1e-5)**2), E=hidden,
                      Cd=observed, input_columns=["delta", "thrust"])
        kalman.smoother()
    states = kalman.x_hats_smooth[3:].T
    return (np.hstack([states, rows[:len(states), 3:]]),
            np.gradient(states, trial.dt, axis=0))
