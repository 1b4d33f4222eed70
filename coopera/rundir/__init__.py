"""A run's folder: its files, who writes them, how they are summed up, exported, and read again."""
