"""Measured and simulated data of others, read where they lie; nothing of them is kept here."""

import glob
import os

import numpy as np

from trials import DataSet, Missing, Ship, Task, read_columns, uniform_trial

NAMES = ("esso-osaka", "gunnerus", "kvlcc2-hsva", "blueboat", "patrol-ship", "sr108", "mariner")


def load(name, shared):
    folder = os.path.join(shared, name)
    if not os.path.isdir(folder):
        raise Missing(f"{folder} is missing")
    return {"esso-osaka": esso_osaka, "gunnerus": gunnerus, "kvlcc2-hsva": kvlcc2,
            "blueboat": blueboat, "patrol-ship": patrol_ship, "sr108": sr108,
            "mariner": mariner}[name](folder)


def files(folder, pattern):
    found = sorted(glob.glob(os.path.join(folder, pattern)))
    if not found:
        raise Missing(f"no file {pattern} in {folder}")
    return found


def stem(path):
    return os.path.splitext(os.path.basename(path))[0]


def renamed(columns, names):
    """Channels by (channel, column, factor)."""
    return {channel: columns[column] * factor for channel, column, factor in names}


def esso_osaka(folder):
    """A 3 m model of a tanker, measured in a pond; the cut copies of two turns are left aside."""
    names = [("t", "t [s]", 1), ("x", "x_position_mid [m]", 1), ("y", "y_position_mid [m]", 1),
             ("psi", "psi_hat [rad]", 1), ("u", "u_velo [m/s]", 1), ("v", "vm_velo [m/s]", 1),
             ("r", "r_angvelo [rad/s]", 1), ("delta", "delta_rudder [rad]", 1),
             ("n", "n_prop [rps]", 1)]
    paths = [p for p in files(folder, "*/*.csv") if "turn_cut" not in p and "berthing" not in p]
    trials = []
    for path in paths:
        channels = renamed(read_columns(path), names)
        channels["psi"] = unwrapped(channels["psi"])
        trials.append(uniform_trial(stem(path), channels, 0.5))
    kind = lambda prefix: [t.name for t in trials if t.name.startswith(prefix)]
    zigzags, turns, random = kind("zigzag"), kind("turn"), kind("random")
    judged = [zigzags[1], zigzags[-1], turns[3], turns[-1]]
    order = [n for pair in zip(zigzags[2:-1], turns[4:]) for n in pair]
    rest = [n for n in zigzags + turns + random if n not in judged + random[::3]]
    tasks = [Task(f"trials-{k}", "few trials", order[:k], judged) for k in (1, 2, 4, 8)]
    tasks += [Task("held-out", "interpolation", rest, judged + random[::3], 60.0),
              Task("zigzags-to-turns", "extrapolation", zigzags, turns[::3], 60.0)]
    ship = Ship("esso-osaka", "tanker", {"lpp_m": 3.0, "beam_m": 0.489, "draught_m": 0.201,
                "block_coefficient": 0.83, "mass_kg": 244.6, "x_g_m": 0.094,
                "rudder_area_m2": 0.0106, "propeller_diameter_m": 0.084}, zoo="esso-osaka-3m")
    return DataSet("esso-osaka", ship, ("delta", "n"), trials, tasks)


def unwrapped(psi):
    """A continuous heading; blank readings stay blank."""
    good = np.isfinite(psi)
    out = np.full(len(psi), np.nan)
    out[good] = np.unwrap(psi[good])
    return out


# From, to (s) and what is sailed.
GUNNERUS = [(480, 690, "turn-30"), (1200, 1410, "turn+30"), (1590, 1800, "zigzag-8"),
            (1950, 2220, "zigzag-10"), (2300, 2570, "turn+10"), (2620, 2910, "zigzag-5"),
            (2970, 3230, "turn-11"), (3300, 3690, "slow-zigzag-10"), (3720, 4050, "slow-zigzag-5"),
            (4130, 4300, "zigzag-20")]


def gunnerus(folder):
    """A research vessel at full scale; two azimuth thrusters count positive to port."""
    columns = read_columns(files(folder, "*.csv")[0])
    psi = np.radians(columns["psi"])
    jump = np.abs(np.angle(np.exp(1j * np.diff(psi)))) > np.radians(6)
    psi[np.convolve(np.r_[False, jump] | np.r_[jump, False], np.ones(5), "same") > 0] = np.nan
    columns["psi"] = unwrapped(psi)
    names = [("t", "tvec", 1), ("x", "N", 1), ("y", "E", 1), ("psi", "psi", 1), ("u", "u", 1),
             ("v", "v", 1), ("r", "r", np.pi / 180), ("delta", "Azi", -np.pi / 180),
             ("n", "RPM", 1 / 60)]
    channels = renamed(columns, names)
    trials = []
    for start, stop, name in GUNNERUS:
        inside = (channels["t"] >= start) & (channels["t"] < stop)
        trials.append(uniform_trial(name, {k: c[inside] for k, c in channels.items()}, 0.5))
    every = [t.name for t in trials]
    but = lambda *names: [n for n in every if n not in names]
    tasks = [Task("held-out", "interpolation", but("zigzag-10", "turn-11", "zigzag-20"),
                  ["zigzag-10", "turn-11", "zigzag-20"], 60.0),
             Task("small-to-large", "extrapolation", but("turn-30", "turn+30", "zigzag-20"),
                  ["turn-30", "turn+30", "zigzag-20"], 60.0),
             Task("full-to-slow", "extrapolation", but("slow-zigzag-10", "slow-zigzag-5"),
                  ["slow-zigzag-10", "slow-zigzag-5"], 60.0),
             Task("trials-2", "few trials", ["zigzag-10", "turn+10"],
                  ["zigzag-8", "turn-11", "zigzag-20"], 60.0)]
    ship = Ship("gunnerus", "research", {"lpp_m": 33.9, "beam_m": 9.6, "draught_m": 2.786,
                "mass_kg": 574127.69}, published="gunnerus-34m")
    return DataSet("gunnerus", ship, ("delta", "n"), trials, tasks)


def kvlcc2(folder):
    """The KVLCC2 at 7 m: velocities are along the earth's axes, the rudder positive to port."""
    trials = []
    for path in files(folder, "*.dat"):
        with open(path, encoding="latin-1") as file:
            rows = np.loadtxt(file.readlines()[4:])
        t, x, y, psi, vx, vy, r, _, rudder, n = rows.T[:10]
        psi = np.radians(psi)
        channels = {"t": t, "x": x, "y": y, "psi": psi, "u": vx * np.cos(psi) + vy * np.sin(psi),
                    "v": vy * np.cos(psi) - vx * np.sin(psi), "r": np.radians(r),
                    "delta": -np.radians(rudder), "n": n}
        trials.append(uniform_trial(stem(path).removeprefix("HSVA_CPMC_KVLCC2_"), channels, 0.3))
    every = [t.name for t in trials]
    large = ["Z_25_05", "Z_35_05"]
    small = [n for n in every if n not in large + ["Z_20_05"]]
    judged = ["Z_10_10_S", "Z_20_05"]
    order = ["Z_25_05", "Z_10_05", "Z_35_05", "Z_10_10_P"]
    tasks = [Task("held-out", "interpolation", [n for n in every if n not in judged], judged, 60.0),
             Task("small-to-large", "extrapolation", small, large, 60.0)]
    tasks += [Task(f"trials-{k}", "few trials", order[:k], judged) for k in (1, 2, 4)]
    ship = Ship("kvlcc2-hsva", "tanker", {"lpp_m": 7.0, "beam_m": 1.2688, "draught_m": 0.455,
                "block_coefficient": 0.8098, "displacement_m3": 3.27, "x_g_m": 0.25,
                "rudder_area_m2": 0.0539, "propeller_diameter_m": 0.216,
                "service_speed_m_s": 1.179}, zoo="kvlcc2-7m", published="kvlcc2-7m")
    return DataSet("kvlcc2-hsva", ship, ("delta", "n"), trials, tasks)


def blueboat(folder):
    """A catamaran with two thrusters by pulses: the column `thr_left` pushes on the starboard
    side and counts the other way (by the measured yaw rate and speed)."""
    trials = []
    for path in files(folder, "fixed_*.csv"):
        columns = read_columns(path)
        t = (columns["original_timestamp"] - columns["original_timestamp"][0]) / 1e3
        channels = {"t": t, "x": columns["x_ned"], "y": columns["y_ned"],
                    "psi": unwrapped(np.radians(columns["yaw"])), "u": columns["surge"],
                    "v": columns["sway"], "r": columns["yaw_rate"],
                    "n_p": (columns["thr_right"] - 1510) / 20,
                    "n_s": (1510 - columns["thr_left"]) / 20}
        trials.append(uniform_trial(stem(path)[-3:], channels, 0.2))
    every = [t.name for t in trials]
    judged = ["220", "230"]
    tasks = [Task("held-out", "interpolation", [n for n in every if n not in judged], judged, 10.0),
             Task("trials-2", "few trials", ["216", "224"], judged, 10.0)]
    sides = "".join(f"  {side}: {{ kind: thruster, x_m: -0.45, y_m: {y}, channels: "
                    f"{{ {channel}: [{channel}_rps] }}, source: owner }}\n"
                    for side, y, channel in (("port", -0.285, "n_p"), ("starboard", 0.285, "n_s")))
    ship = Ship("blueboat", "usv", {"lpp_m": 1.2, "beam_m": 0.93, "draught_m": 0.1,
                                    "mass_kg": 15.0}, actuators=sides)
    return DataSet("blueboat", ship, ("n_p", "n_s"), trials, tasks)


def patrol_ship(folder):
    """A patrol ship in wind and waves, simulated by others; heading follows from the yaw rate."""
    columns = read_columns(files(folder, "*.csv")[0])
    channels = renamed(columns, [("t", "time", 1), ("u", "u", 1), ("v", "v", 1), ("r", "r", 1),
                                 ("n", "n", 1 / 60)])
    channels["delta"] = -(columns["deltal"] + columns["deltar"]) / 2
    if np.corrcoef(channels["delta"], channels["r"])[0, 1] < 0:
        channels["delta"] = -channels["delta"]
    trials = []
    for k in range(6):
        inside = slice(300 * k, 300 * (k + 1))
        piece = {name: values[inside] for name, values in channels.items()}
        trials.append(uniform_trial(f"minutes-{5 * k}", piece, 1.0))
    every = [t.name for t in trials]
    tasks = [Task("held-out", "interpolation", every[:4], every[4:], 60.0),
             Task("trials-1", "few trials", every[:1], every[4:], 60.0)]
    ship = Ship("patrol-ship", "patrol", {"lpp_m": 51.5, "beam_m": 8.6, "draught_m": 2.3})
    return DataSet("patrol-ship", ship, ("delta", "n"), trials, tasks)


def sr108(folder):
    """A container ship, simulated by others, with noise; the worked example without an effect."""
    names = [("t", "t_s", 1), ("x", "x_m", 1), ("y", "y_m", 1), ("psi", "psi_rad", 1),
             ("u", "u_mps", 1), ("v", "v_mps", 1), ("r", "r_radps", 1), ("delta", "delta_rad", 1),
             ("n", "n_rpm", 1 / 60)]
    read = lambda path: uniform_trial(stem(path).replace("__noisy", "").replace("__", "_"),
                                      renamed(read_columns(path), names), 1.0)
    noisy = [read(path) for path in files(folder, "examples/i_control__*.csv")]
    clean = [read(path) for path in files(folder, "reference/*.csv")]
    zigzags = [t.name for t in noisy if "zz" in t.name]
    turns = [t.name for t in noisy if "turn" in t.name]
    fast = [t.name for t in clean if "24.7" in t.name]
    slower = [t.name for t in clean if "24.7" not in t.name]
    tasks = [Task("zigzags-to-turns", "extrapolation", zigzags, turns, 200.0),
             Task("slow-to-fast", "extrapolation", zigzags + slower, fast, 200.0)]
    ship = Ship("sr108", "dry-cargo", {"lpp_m": 175.0, "beam_m": 25.4, "draught_m": 8.5,
                "block_coefficient": 0.562, "displacement_m3": 21222.0, "rudder_area_m2": 33.0376,
                "propeller_diameter_m": 6.533, "service_speed_m_s": 12.42}, zoo="sr108",
                published="sr108", made_by_published=True)
    return DataSet("sr108", ship, ("delta", "n"), noisy + clean, tasks)


def mariner(folder):
    """The Mariner, simulated by others without noise; no revolutions are recorded."""
    names = [("t", "t_s", 1), ("x", "x_m", 1), ("y", "y_m", 1), ("psi", "psi_rad", 1),
             ("u", "u_mps", 1), ("v", "v_mps", 1), ("r", "r_radps", 1), ("delta", "delta_rad", 1)]
    trials = [uniform_trial(stem(path), renamed(read_columns(path), names), 1.0)
              for path in files(folder, "*.csv")]
    zigzags = [t.name for t in trials if t.name.startswith("zigzag")]
    turns = [t.name for t in trials if t.name.startswith("turn")]
    tasks = [Task("zigzags-to-turns", "extrapolation", zigzags, turns, 200.0),
             Task("trials-1", "few trials", ["zigzag_20_20"], ["zigzag_10_10", *turns])]
    ship = Ship("mariner", "dry-cargo", {"lpp_m": 160.93, "beam_m": 23.2, "draught_m": 8.23,
                "block_coefficient": 0.59, "displacement_m3": 18541.0, "rudder_area_m2": 30.01,
                "propeller_diameter_m": 6.706, "service_speed_m_s": 7.7175}, zoo="mariner",
                published="mariner", made_by_published=True)
    return DataSet("mariner", ship, ("delta",), trials, tasks)
