"""What both sides of the offline model share: the household knowledge file, reading of variables, and similarity.

Nothing here is about a particular person.
"""
