"""Import of homes in Habitat's layout, those of HSSD and ReplicaCAD among them.

Their files, names, meshes and walls become homes of ours.
"""
