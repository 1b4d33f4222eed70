"""Homes of the Habitat Synthetic Scenes Dataset (HSSD): its files, names and walls, read into a home of ours."""
