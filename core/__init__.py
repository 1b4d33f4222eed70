"""The vocabulary of all rooms: people, time, the household, the hour, prompts' variables and replies, errors.

It imports no other room, and has no I/O.
"""

if __name__ == "core":  # imported from a clone by its folder's name: its modules exist once, as coopera.core.…
    __path__ = []
