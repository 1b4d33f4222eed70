"""Import of ProcTHOR's houses: rooms and doors as they are published, objects as ours of the published sizes.

What is guessed and what is left out is said in a report.
"""
