"""Where bodies can stand and walk in a home as it is built.

Whether a home can be lived in, with everything within reach, is checked here.
"""
