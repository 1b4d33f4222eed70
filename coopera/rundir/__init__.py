"""The run directory: the files of a run, and the lock of the process that writes them.

Summaries, exports and earlier lives are read from these files.
"""
