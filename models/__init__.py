"""Physics and mathematics of fluid inerters: operators, devices, terms, models, simulation.

Everything is SI. This package never imports :mod:`discover`.
"""
