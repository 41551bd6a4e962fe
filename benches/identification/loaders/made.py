"""Ships made by seed, with forces in forms that no law of the program's zoo has.

Hull: lift by sin(2 beta), cross-flow drag by strips whose coefficient changes along the length,
resistance with a hump. Propulsion: five kinds, each with equations of its own. Integrated by
Runge and Kutta's method; readings have Gaussian noise.
"""

import zlib

import numpy as np

from trials import DataSet, Ship, Task, Trial, track

KINDS = ("cargo", "azimuth", "water-jet", "outboard", "catamaran")
NAMES = tuple(f"made-{kind}-{seed}" for kind in KINDS for seed in (1, 2))
CATEGORIES = {"cargo": "general-cargo", "azimuth": "offshore", "water-jet": "patrol",
              "outboard": "boat", "catamaran": "usv"}
SIZES = {"cargo": (95, 130), "azimuth": (30, 37), "water-jet": (18, 26), "outboard": (7, 9),
         "catamaran": (2, 6)}
FROUDE = {"cargo": 0.22, "azimuth": 0.28, "water-jet": 0.5, "outboard": 0.55, "catamaran": 0.3}
RHO, GRAVITY = 1000.0, 9.81
STRIPS = np.linspace(-0.475, 0.475, 20)
NOISE = {"u": 0.003, "v": 0.003, "r": 0.003, "psi": 0.002}
FITTED = [("zigzag", 20, 1.0), ("turn", 25, 1.0), ("zigzag", -10, 1.0), ("turn", -15, 0.7),
          ("random", 25, 1.0), ("zigzag", 10, 0.7), ("turn", -30, 1.0), ("random", 15, 0.8)]
ZIGZAGS = [("zigzag", -20, 1.0), ("zigzag", 10, 1.0)]
JUDGED = [("turn", 35, 1.0), ("turn", -20, 1.0), ("zigzag", 15, 1.0), ("random", 20, 0.9)]
SLOW = [("turn", 30, 0.6), ("zigzag", 20, 0.6)]
# Trials after something has changed that the columns do not show, of ships with one angle.
CHANGED = [("zigzag", 20, 1.0), ("turn", 25, 1.0), ("zigzag", -10, 1.0), ("turn", -30, 1.0)]
EFFECTS = ("none", "rudder-offset", "propeller-damage", "yaw-rate-bias")
OFFSET, THRUST_LOSS, RATE_BIAS = np.radians(2.5), 0.85, 0.02


def load(name, _folder):
    kind, seed = name.removeprefix("made-").rsplit("-", 1)
    craft = Craft(kind, np.random.default_rng(1000 * int(seed) + KINDS.index(kind)))
    runs = FITTED + ZIGZAGS + JUDGED + SLOW
    trials = [craft.record(run, np.random.default_rng(zlib.crc32(repr((name, run)).encode())))
              for run in runs]
    fitted, judged = [title(run) for run in FITTED], [title(run) for run in JUDGED]
    zigzags = [title(run) for run in ZIGZAGS + FITTED if run[0] == "zigzag" and run[2] == 1.0]
    full = [title(run) for run in FITTED if run[2] == 1.0]
    restart = float(10 * craft.length / craft.speed)
    few = [Task(f"trials-{k}", "few trials", fitted[:k], judged, restart if k == 8 else 0.0)
           for k in (1, 2, 4, 8)]
    further = [Task("zigzags-to-turns", "extrapolation", zigzags, judged[:2]),
               Task("full-to-slow", "extrapolation", full, [title(run) for run in SLOW])]
    if kind == "catamaran":
        return DataSet(name, craft.ship(name), ("n_p", "n_s"), trials, few + further)
    hidden = []
    for effect in EFFECTS:
        craft.effect = effect
        seeds = [zlib.crc32(repr((effect, run)).encode()) for run in CHANGED]
        changed = [craft.record(run, np.random.default_rng(seed))
                   for run, seed in zip(CHANGED, seeds)]
        for trial in changed:
            trial.name = f"{effect}_{trial.name}"
        trials += changed
        hidden.append(Task(f"hidden-{effect}", "diagnosis", fitted, [t.name for t in changed]))
    return DataSet(name, craft.ship(name), ("delta", "n"), trials, few + further + hidden)


def title(run):
    return f"{run[0]}_{run[1]}_{run[2]}"


class Craft:
    """A ship drawn at random within a kind."""

    def __init__(self, kind, rng):
        self.kind, self.effect = kind, "none"
        self.length = rng.uniform(*SIZES[kind])
        self.beam = self.length / rng.uniform(4.5, 6.5)
        self.draught = self.beam / rng.uniform(2.4, 3.4)
        self.speed = FROUDE[kind] * np.sqrt(GRAVITY * self.length)
        self.block = rng.uniform(0.55, 0.75)
        mass = RHO * self.block * self.length * self.beam * self.draught
        self.surge, self.sway = mass * rng.uniform(1.03, 1.08), mass * rng.uniform(1.6, 1.9)
        self.inertia = mass * (rng.uniform(0.30, 0.36) * self.length)**2
        self.drag = rng.uniform(0.7, 1.1) * (1 + rng.uniform(0.1, 0.7) * STRIPS)
        self.lift, self.lever = rng.uniform(0.25, 0.4), rng.uniform(0.15, 0.25)
        self.damping = rng.uniform(0.04, 0.07)
        self.hump, self.walk = rng.uniform(0.1, 0.4), rng.uniform(-0.02, 0.02)
        self.revolutions = rng.uniform(8, 12) / np.sqrt(self.length / 5)
        self.area = rng.uniform(0.018, 0.028) * self.length * self.draught
        self.resistance = 0.5 * RHO * rng.uniform(0.02, 0.03) * self.length * self.draught
        self.thrust = self.drag_ahead(self.speed) / (1 - rng.uniform(0.35, 0.5))
        self.advance = 1 - self.drag_ahead(self.speed) / self.thrust

    def drag_ahead(self, u):
        hump = 1 + self.hump * np.exp(-((abs(u) / self.speed - 0.8) / 0.2)**2)
        return self.resistance * u * abs(u) * hump

    def push(self, n, u):
        """Thrust of all propellers: quadratic in revolutions, falling with the advance."""
        k, a = n / self.revolutions, u / self.speed
        if self.effect == "propeller-damage":
            return THRUST_LOSS * self.sound_push(k, a)
        return self.sound_push(k, a)

    def sound_push(self, k, a):
        if self.kind == "water-jet":
            return self.thrust * k * (k - self.advance * a)
        return self.thrust * (k * abs(k) - self.advance * a * (0.8 * abs(k) + 0.2 * a))

    def steer(self, state, orders):
        """Longitudinal and lateral force and moment of the propulsion."""
        u, v, r = state
        half = self.length / 2
        if self.kind == "catamaran":
            port, starboard = (self.push(n, u) / 2 for n in orders)
            return port + starboard, 0.0, (port - starboard) * 0.4 * self.beam * 2
        angle, n = orders
        angle += OFFSET if self.effect == "rudder-offset" else 0.0
        push, inflow = self.push(n, u), v - half * r
        if self.kind == "cargo":
            wash = np.sqrt(u * u + max(push, 0) / (0.5 * RHO * np.pi * (0.35 * self.draught)**2))
            attack = angle + np.arctan2(0.6 * inflow, max(wash, 1e-3))
            force = 0.5 * RHO * self.area * wash**2 * 2.4 * stalled(attack)
            side = self.walk * push - force * np.cos(angle)
            return push - abs(force * np.sin(angle)), side, -half * side
        if self.kind == "outboard":
            push = push * (1 - 0.25 * np.sin(angle)**2) * (1 - 0.1 * abs(inflow) / self.speed)
        attack = angle + np.arctan2(inflow, max(abs(u), 0.1 * self.speed))
        legs = 0.0 if self.kind == "water-jet" else stalled(attack)
        foil = 0.35 * RHO * self.area * (u * u + 0.3 * self.speed**2) * legs
        side = self.walk * push - push * np.sin(angle) - foil
        return push * np.cos(angle) - abs(foil * np.sin(angle)), side, -half * side

    def rate(self, state, orders):
        """Accelerations in surge, sway and yaw."""
        u, v, r = state
        x, y, n = self.steer(state, orders)
        across = v + STRIPS * self.length * r
        strips = 0.5 * RHO * self.draught * self.length * self.drag * across * abs(across) / 20
        speed = np.hypot(u, v)
        lift = 0.5 * RHO * self.length * self.draught * self.lift * speed**2
        lift *= np.sin(2 * np.arctan2(v, max(abs(u), 1e-6)))
        damping = 0.5 * RHO * self.length**3 * self.draught * self.damping * speed * r
        shift = 0.35 * self.sway * v * r
        return np.array([
            (x - self.drag_ahead(u) + shift) / self.surge,
            (y - lift - strips.sum() - self.surge * u * r) / self.sway,
            (n - lift * self.lever * self.length - damping
             - (strips * STRIPS).sum() * self.length) / self.inertia])

    def record(self, run, rng):
        """A manoeuvre as its instruments recorded it, at a fifteenth of a length's time."""
        manoeuvre, degrees, share = run
        dt, count = self.length / self.speed / 15, 675
        state = np.array([self.speed * share, 0.0, 0.0])
        angle = heading = 0.0
        target = first = np.radians(degrees)
        rows = []
        for k in range(count):
            order = 0.0 if k < 30 else target
            if manoeuvre == "zigzag" and k >= 30 and heading * np.sign(target) >= abs(first):
                target = -target
            if manoeuvre == "random" and k % 40 == 0:
                target = rng.uniform(-1, 1) * abs(first)
            angle += np.clip(order - angle, -0.4 / 15, 0.4 / 15) if angle != order else 0.0
            n = self.revolutions * share
            orders = (n * (1 + angle), n * (1 - angle)) if self.kind == "catamaran" else (angle, n)
            rows.append([k * dt, *state, heading, *orders])
            moved = self.advanced(state, orders, dt)
            heading += dt * (state[2] + moved[2]) / 2
            state = moved
        return self.reading(title(run), np.array(rows).T, dt, rng)

    def advanced(self, state, orders, dt):
        first = self.rate(state, orders)
        second = self.rate(state + dt / 2 * first, orders)
        third = self.rate(state + dt / 2 * second, orders)
        fourth = self.rate(state + dt * third, orders)
        return state + dt / 6 * (first + 2 * second + 2 * third + fourth)

    def reading(self, name, rows, dt, rng):
        names = ("t", "u", "v", "r", "psi", *(("n_p", "n_s") if self.kind == "catamaran"
                                              else ("delta", "n")))
        channels = dict(zip(names, rows))
        channels["x"], channels["y"] = track(channels["u"], channels["v"], channels["psi"], dt)
        scale = {"u": self.speed, "v": self.speed, "r": self.speed / self.length, "psi": 1.0}
        if self.effect == "yaw-rate-bias":
            channels["r"] = channels["r"] + RATE_BIAS * scale["r"]
        for channel, share in NOISE.items():
            channels[channel] = channels[channel] + rng.normal(0, share * scale[channel],
                                                               len(channels["t"]))
        return Trial(name, channels)

    def ship(self, name):
        values = {"lpp_m": self.length, "beam_m": self.beam, "draught_m": self.draught,
                  "block_coefficient": self.block, "service_speed_m_s": self.speed}
        if self.kind == "cargo":
            values |= {"rudder_area_m2": self.area, "propeller_diameter_m": 0.7 * self.draught}
        sides = ""
        if self.kind == "catamaran":
            aft, out = -0.45 * self.length, 0.4 * self.beam
            sides = "".join(f"  {side}: {{ kind: thruster, x_m: {aft:.3f}, y_m: {y:.3f}, "
                            f"channels: {{ {channel}: [{channel}_rps] }}, source: owner }}\n"
                            for side, y, channel in (("port", -out, "n_p"),
                                                     ("starboard", out, "n_s")))
        return Ship(name, CATEGORIES[self.kind],
                    {key: round(float(value), 4) for key, value in values.items()},
                    actuators=sides)


def stalled(attack):
    """Lift factor of a low-aspect wing that stalls softly near 35 degrees."""
    return np.sin(attack) * np.cos(attack) / (1 + (abs(attack) / 0.6)**6)
