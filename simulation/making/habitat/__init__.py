"""The import of homes from the Habitat Synthetic Scenes Dataset (HSSD).

Its files, names and walls become a home of ours.
"""
