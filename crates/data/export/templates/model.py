"""A ship manoeuvring model: `rates`, `step` and `simulate`. The comment above says what it is."""

import math

STATES = ("u", "v", "r", "p", "phi", "psi", "x", "y", "delta")

# Inputs of straight running at the approach speed.
INPUTS = {
@@inputs}

COEFFICIENTS = {
@@coefficients}

SPEED_M_S = @@speed_m_s


def _quotient(a, b):
    if b != 0.0:
        return a/b
    return math.nan if a == 0.0 or a != a else math.copysign(math.inf, a)*math.copysign(1.0, b)


def _safe(function, *arguments):
    """What is undefined is not a number, and what is too large is infinite."""
    try:
        return function(*arguments)
    except OverflowError:
        return math.inf
    except ValueError:
        return -math.inf if function is math.log and arguments[0] == 0.0 else math.nan


def _solve(rows):
    """Solves equations given as rows of coefficients and right-hand side."""
    size = len(rows)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k]/rows[k][k]
            rows[i] = [a - factor*b for a, b in zip(rows[i], rows[k])]
    out = [0.0]*size
    for k in reversed(range(size)):
        known = sum(rows[k][j]*out[j] for j in range(k + 1, size))
        out[k] = (rows[k][size] - known)/rows[k][k]
    return out


def approach():
    """The state of straight running at the approach speed, heading north."""
    return [SPEED_M_S] + [0.0]*8


def rates(state, inputs=INPUTS, coefficients=COEFFICIENTS, step_s=@@step):
    """The rates of the states. A gear without a time constant goes to its order within `step_s`, the
    step with which the rates are integrated."""
    u, v, r, p, phi, psi, x, y, delta = state
@@unpack
@@statements
@@rudder
    return [u_dot, v_dot, r_dot, p_dot, phi_dot, psi_dot, x_dot, y_dot, delta_dot]


@@rangedef check(state):
    """Raises ArithmeticError where the simulation is no longer believed."""
    if not all(math.isfinite(value) for value in state):
        raise ArithmeticError("the state is no longer a number")
    if math.hypot(state[0], state[1]) > @@most_speed:
        raise ArithmeticError("the speed left the physical range")
    if abs(state[2]) > @@most_yaw:
        raise ArithmeticError("the yaw rate left the physical range")
    if abs(state[4]) > @@most_roll:
        raise ArithmeticError("the ship has capsized")


def step(state, inputs=INPUTS, step_s=@@step, coefficients=COEFFICIENTS):
    """The state one step of the classical Runge-Kutta method of fourth order later, inputs held."""
    def at(rate, by_s):
        return [a + b*by_s for a, b in zip(state, rate)]

    k1 = rates(state, inputs, coefficients, step_s)
    k2 = rates(at(k1, 0.5*step_s), inputs, coefficients, step_s)
    k3 = rates(at(k2, 0.5*step_s), inputs, coefficients, step_s)
    k4 = rates(at(k3, step_s), inputs, coefficients, step_s)
    later = at([a + 2.0*(b + c) + d for a, b, c, d in zip(k1, k2, k3, k4)], step_s/6.0)
    check(later)
    return later


def run(duration_s, step_s=@@step, state=None, coefficients=COEFFICIENTS, **inputs):
    """Yields time and state at each step; an input is a number, or a function of time and state."""
    for name in inputs:
        if name not in INPUTS:
            raise TypeError(f"there is no input {name}; the inputs are {', '.join(INPUTS)}")
    state = list(approach() if state is None else state)
    for k in range(round(duration_s/step_s) + 1):
        t = k*step_s
        yield t, state
        given = {n: f(t, state) if callable(f) else f for n, f in inputs.items()}
        state = step(state, {**INPUTS, **given}, step_s, coefficients)


def simulate(duration_s, step_s=@@step, state=None, coefficients=COEFFICIENTS, **inputs):
    """Time and states as numpy arrays: `t, states = simulate(600.0, delta_order=0.6)`."""
    import numpy

    rows = list(run(duration_s, step_s, state, coefficients, **inputs))
    return numpy.array([t for t, _ in rows]), numpy.array([state for _, state in rows])


if __name__ == "__main__":
    # A turning circle as CSV: python FILE.py [RUDDER_DEG [DURATION_S [STEP_S]]]
    import sys

    given = [float(argument) for argument in sys.argv[1:]]
    rudder_deg, duration_s, step_s = given + [35.0, @@duration, @@step][len(given):]
    print("t_s,u_m_s,v_m_s,r_rad_s,p_rad_s,phi_rad,psi_rad,x_m,y_m,delta_rad")
    for t, state in run(duration_s, step_s, @@order):
        print(",".join(repr(value) for value in [t] + state))
