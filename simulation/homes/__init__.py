"""A home as data: rooms, doorways, fixed and movable objects and the places on them, read from files and checked.

The catalogue describes each class of object; nothing here needs pybullet.
"""
