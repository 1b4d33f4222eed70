"""The version of coopera."""

__version__ = "0.2.0"
