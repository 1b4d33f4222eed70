"""The truth of a home as plain data: who and what is where, and how it is.

What must be true of it at every moment is said here, too, and what can be seen of it, and where there is a free place.
"""
