"""The bodies that move in a home: the person's joints and reach, and each robot's URDF, arm and measures.

`robot.ROBOTS` lists the robots that ship.
"""
