"""The making of homes: generated from a seed, furnished, or imported from HSSD.

A new home is proved usable, and drawn from above.
"""
