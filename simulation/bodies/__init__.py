"""The bodies that move in a home: the person's joints and reach, and each robot's URDF, arm and measures.

A robot is two files, NAME.urdf and NAME.yaml; `robot.known_robots` lists those that ship.
"""
