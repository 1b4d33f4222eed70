"""Benchmarks: the runs of a grid, on this machine or on a Ray cluster, and their result files.

The leaderboard checks and ranks such results.
"""
