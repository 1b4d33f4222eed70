"""The common sense of the offline person, robot and judge: the household file, the reading of variables, similarity.

Nothing here is about a particular person.
"""
