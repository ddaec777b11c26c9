"""Campaigns of devices with a fractional order, from the steady state's own formula.

A sine X sin(w t) through a fractional derivative of order a is X w^a sin(w t + a pi / 2); nothing
here is of the package.
"""

import numpy as np


def make_device(folder, order, *, noise, frequencies, amplitudes=(0.005, 0.01), seed=0):
    """Write a campaign: force 3000 N s^a/m and 40 N of dry friction, white noise over the force."""
    generator = np.random.default_rng(seed)
    folder.mkdir(parents=True)
    lines = [f'title = "{folder.name}"']
    for i, (f, size) in enumerate((f, a) for f in frequencies for a in amplitudes):
        w = 2.0 * np.pi * f
        t = np.arange(6 * 120) / (120.0 * f)
        force = 3000.0 * size * w**order * np.sin(w * t + 0.5 * np.pi * order)
        force += 40.0 * np.tanh(np.cos(w * t) / 0.05)
        force += noise * np.sqrt(np.mean(force**2)) * generator.standard_normal(t.size)
        table = np.column_stack([t, size * np.sin(w * t), force])
        head = "time [s],displacement [m],force [N]"
        np.savetxt(folder / f"{i}.csv", table, "%.9g", ",", header=head, comments="")
        lines += ["[[records]]", f'file = "{i}.csv"']
    (folder / "campaign.toml").write_text("\n".join(lines) + "\n")
