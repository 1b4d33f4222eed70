"""Homes that a user keeps: imported, generated or written, stored in the data folder, and counted."""
