"""Checks before a run: will this model, this household file or this method work?

The estimate foretells what a run will cost.
"""
