"""Goals: what should be true of a home, at a moment or over a day. As text, as YAML, and as small immutable trees.

A goal is made of atoms such as on(mug, dining table), each of which asks the state of the home.
"""
