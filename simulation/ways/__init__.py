"""Where bodies can stand and walk in a home as it is built, and whether everything in it can be reached."""
