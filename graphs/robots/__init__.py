"""What a robot is: a method as data, the view of all that it may know, how it recalls, believes and learns.

A robot of one's own is a class with the functions of `own_robot.Robot`.
"""
