"""Before a benchmark is run: what its endpoint's test would find, by simulation."""
