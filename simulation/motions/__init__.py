"""The motions a person can make: the shipped library, the user's own folder of clips, and SMPL-X files.

A motion is a name, words that describe it, and poses over time.
"""
