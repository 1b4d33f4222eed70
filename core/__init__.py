"""The vocabulary everyone speaks: people, time, the household, the hour, replies, errors. No I/O."""

if __name__ == "core":  # imported from a clone by its folder's name: its modules exist once, as coopera.core.…
    __path__ = []
