"""Homes of ProcTHOR: house JSON as it is published becomes a home of ours.

Its objects are drawn by our own shapes where their types or names say what they are, and as boxes where not.
"""
