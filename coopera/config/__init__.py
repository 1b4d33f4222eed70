"""The configuration of a run: its fields, their defaults and their checks.

Files are read strictly and written atomically here.
"""
