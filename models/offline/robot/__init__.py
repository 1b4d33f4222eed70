"""The offline model as the robot: candidates from percept, memories and belief, and the evening's inference of traits.

It knows the household file, but no person: the room `human` is out of its reach.
"""
