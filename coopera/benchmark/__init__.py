"""Many studies compared: the grid's runs, their results on file, a Ray cluster, and the leaderboard."""
