"""Before a benchmark is run: what its endpoint's test would find, by simulation.

How much differences scatter is estimated from results, or assumed. Here nothing is run.
"""
