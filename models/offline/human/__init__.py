"""The offline model as the person: who they are, what they choose, how they do it, and what they answer in the evening.

The robot's and the judge's side cannot reach this room; a test walks the imports to see that.
"""
