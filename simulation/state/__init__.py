"""The truth of a home as plain data: who and what is where and how, what must be true of it, and free places."""
