"""What people look like: who is drawn how, the mesh of a body, and what is worn over it; for pictures alone.

Bodies are fields of signed distances, whose surfaces are meshed. A field tells for points how far they are from a
surface (metres, negative inside). All points are those of the rest pose, in the pelvis's frame: x forward, y left,
z up. Where a body's parts are is in `coopera.simulation.bodies.humanoid`.
"""
