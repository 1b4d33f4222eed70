"""What a server may do to whoever asks it. Its answers are held to bounds of time, size, depth and counts of tokens."""
