"""A home as data: rooms, furniture, objects and the places on them, read from files and checked.

The catalogue says what each class of object is; nothing here needs pybullet.
"""
