"""The commands, one module per group; each is a thin layer over a function that Python can call too."""
