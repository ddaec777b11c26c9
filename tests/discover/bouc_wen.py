"""A mass on a spring with the hysteresis of Bouc and Wen, as a benchmark of that name has it."""

import numpy as np

MASS, DAMPING, STIFFNESS = 2.0, 10.0, 5e4


def random_force(size, count, step, rng):
    """Return a force (N,) of random phases from 5 to 150 Hz, of so many N root mean square."""
    lines = np.fft.rfftfreq(count, step)
    wave = np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, lines.size))
    push = np.fft.irfft(np.where((lines > 5.0) & (lines < 150.0), wave, 0.0), count)
    return push * size / push.std()


def driven(force, step, between):
    """Return its path under a force (N,).

    By Runge and Kutta's rule, so many steps to a sample; the force is gone through twice.
    """
    force = np.fft.irfft(np.fft.rfft(force), force.size * between) * between
    step, path, state = step / between, np.empty(force.size), np.zeros(3)

    def slope(s, f):
        push = (f - DAMPING * s[1] - STIFFNESS * s[0] - s[2]) / MASS
        memory = 5e4 * s[1] - 1e3 * (0.8 * abs(s[1]) * s[2] - 1.1 * s[1] * abs(s[2]))
        return np.array([s[1], push, memory])

    for _ in range(2):
        for i in range(force.size):
            path[i] = state[0]
            f, g = force[i], force[(i + 1) % force.size]
            one = slope(state, f)
            two = slope(state + 0.5 * step * one, 0.5 * (f + g))
            three = slope(state + 0.5 * step * two, 0.5 * (f + g))
            four = slope(state + step * three, g)
            state = state + step / 6.0 * (one + 2.0 * two + 2.0 * three + four)
    return path[::between]
