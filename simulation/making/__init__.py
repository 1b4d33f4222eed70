"""Homes that are made: generated from a seed, furnished, imported from HSSD, proved usable, drawn from above."""
