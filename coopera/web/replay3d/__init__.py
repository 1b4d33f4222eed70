"""A day in 3D: all that happened in a home as one page with a time bar, or as a film.

Both come from a run's trace alone.
"""
