"""shipmmg: its estimate of K and T (Nomoto), or its MMG model of three degrees of freedom with the
coefficients of its example (KVLCC2), nine of which SciPy's least squares fits through its solver.
"""

import numpy as np
from scipy.optimize import least_squares
from shipmmg.kt import KTParams, simulate_kt
from shipmmg.mmg_3dof import Mmg3DofBasicParams, Mmg3DofManeuveringParams, simulate_mmg_3dof
from shipmmg.ship_obj_3dof import ShipObj3dof

from job import CannotDo
from motion import limits
from peers.mmg_scipy import segments
from selection import select
from trials import STATES

RHO = 1000.0
HULL = {"k_0": 0.2931, "k_1": -0.2753, "k_2": -0.1385, "R_0_dash": 0.022, "X_vv_dash": -0.040,
        "X_vr_dash": 0.002, "X_rr_dash": 0.011, "X_vvvv_dash": 0.771, "Y_v_dash": -0.315,
        "Y_r_dash": 0.083, "Y_vvv_dash": -1.607, "Y_vvr_dash": 0.379, "Y_vrr_dash": -0.391,
        "Y_rrr_dash": 0.008, "N_v_dash": -0.137, "N_r_dash": -0.049, "N_vvv_dash": -0.030,
        "N_vvr_dash": -0.294, "N_vrr_dash": 0.055, "N_rrr_dash": -0.013}
FITTED = ("f_α", "k_0", "R_0_dash", "Y_v_dash", "Y_r_dash", "N_v_dash", "N_r_dash", "Y_vvr_dash",
          "N_vvr_dash")


def fit(task):
    given = task.ship.particulars
    if task.controls[0] != "delta":
        raise CannotDo("the model has a rudder, the ship has none")
    methods = {"KT": fit_nomoto}
    if {"propeller_diameter_m", "rudder_area_m2"} <= set(given):
        # Revolutions that are not recorded: constant, at an advance ratio of 0.6.
        speed = np.median(np.concatenate([trial["u"] for trial in task.trials]))
        ship = {**given, "held_rps": 0.6 * speed / (0.6 * given["propeller_diameter_m"])}
        methods["MMG"] = lambda trials: fit_mmg(ship, trials)
    return select(list(methods), lambda trials, method: methods[method](trials), task.trials)


def fit_nomoto(trials):
    """K and T by `estimate_KT_LSM` of each trial, weighted by its length."""
    found = []
    for trial in trials:
        ship = ShipObj3dof(L=1.0, B=1.0)
        ship.time, ship.r, ship.δ = trial["t"], trial["r"], trial["delta"]
        found.append(ship.estimate_KT_LSM())
    gain, lag = np.average(found, axis=0, weights=[len(trial) for trial in trials])

    def run(truth):
        rate = simulate_kt(KTParams(gain, lag), truth["t"], truth["delta"], r0=truth["r"][0])
        rate = rate.sol(truth["t"])[0]
        return {"u": np.full(len(truth), truth["u"][0]), "v": 0 * rate, "r": rate}
    return Model(run, 2)


def fit_mmg(given, trials):
    bound = limits(trials)
    pieces = [window.truth for window in segments(trials, 8 * given["lpp_m"] / bound[0] * 3)]
    pieces = pieces[::-(-len(pieces) // 10)]
    spread = np.concatenate([piece.columns(STATES) for piece in pieces]).std(axis=0) + 1e-9

    def residuals(shifted):
        z = shifted - 10
        missed = [misses(simulate(given, z, piece, bound), piece, spread) for piece in pieces]
        missed = np.concatenate(missed)
        return np.append(missed, z * np.sqrt(len(missed)) / 30)
    # Parameters about ten: SciPy's steps are relative, and those of the solver's noise too small.
    z = least_squares(residuals, np.full(len(FITTED), 10.0), loss="soft_l1", max_nfev=12,
                      diff_step=2e-3, bounds=(6, 14)).x - 10
    return Model(lambda truth: simulate(given, z, truth, bound), len(FITTED))


def misses(run, piece, spread):
    if run is None:
        return np.full(3 * len(piece), 10.0)
    return np.concatenate([(run[s] - piece[s]) / spread[k] for k, s in enumerate(STATES)])


def simulate(given, z, truth, bound):
    """Speeds by `simulate_mmg_3dof`; None where they leave the limits of motion."""
    factors = dict(zip(FITTED, np.exp(0.4 * z)))
    hull = {name: value * factors.get(name, 1.0) for name, value in HULL.items()}
    basic = particulars(given, factors["f_α"])
    held = np.full(len(truth), given["held_rps"])
    turning = truth["n"] if "n" in truth.channels else held

    def within(_, state):
        return np.min(bound - np.abs(state[:3]))
    within.terminal = True
    found = simulate_mmg_3dof(basic, Mmg3DofManeuveringParams(**hull), truth["t"], truth["delta"],
                              turning, *(truth[s][0] for s in STATES), ρ=RHO, events=within,
                              rtol=1e-3, atol=1e-5)
    if found.status != 0:
        return None
    return dict(zip((*STATES, "x", "y", "psi"), found.sol(truth["t"])))


def particulars(given, factor):
    """Those of a user, and the example's ratios for those that a user does not know."""
    length, beam, draught = given["lpp_m"], given["beam_m"], given["draught_m"]
    mass = RHO * given.get("block_coefficient", 0.7) * length * beam * draught
    force, area = 0.5 * RHO * length**2 * draught, given["rudder_area_m2"]
    return Mmg3DofBasicParams(
        L_pp=length, B=beam, d=draught, x_G=0.0, D_p=given["propeller_diameter_m"], m=mass,
        I_zG=mass * (0.25 * length)**2, A_R=area,
        η=min(1.0, given["propeller_diameter_m"] / np.sqrt(2 * area)), m_x=0.022 * force,
        m_y=0.223 * force, J_z=0.011 * force * length**2, f_α=2.747 * factor, ϵ=1.09, t_R=0.387,
        x_R=-0.5 * length, a_H=0.312, x_H=-0.464 * length, γ_R_minus=0.395, γ_R_plus=0.640,
        l_R=-0.710, κ=0.5, t_P=0.220, w_P0=0.40, x_P=-0.650)


class Model:
    def __init__(self, run, parameters):
        self.run, self.parameters = run, parameters

    def simulate(self, windows):
        return [self.run(window.truth) for window in windows]
