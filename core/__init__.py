"""The vocabulary everyone speaks: people, time, the household, the hour, replies, errors. No I/O."""
