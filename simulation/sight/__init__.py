"""What is seen of the home: the physics engine's scene, cameras, frames, video, and the robot's percept.

`recording` films an act; `percept` turns what a camera sees into words.
"""
