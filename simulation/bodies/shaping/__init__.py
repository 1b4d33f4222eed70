"""The shape of a person: fields of signed distances, the surfaces where they are zero, and what is worn over them.

A field tells for points how far they are from a surface (metres, negative inside). All points are those of the rest
pose, in the pelvis's frame: x forward, y left, z up.
"""
