"""The homes of a user: imported, generated or written by hand, and stored in the data folder.

The statistics of all homes are computed here, too.
"""
