"""The commands of the command line, one module per group.

Each command is a thin layer over a function for Python.
"""
