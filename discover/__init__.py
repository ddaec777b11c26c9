"""Model discovery for fluid inerters: which structure holds, where, how surely, what it misses."""
