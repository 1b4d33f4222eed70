"""The bodies that move in a home: the person's joints and reach, and each robot's URDF, arm and measures.

A robot is a URDF and the file NAME.yaml; `robot.known_robots` lists those that ship.
"""
