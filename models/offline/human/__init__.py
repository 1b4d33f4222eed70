"""The offline model as the person: character, choices, tasks, reflection, and the evening's feedback.

The robot's and the judge's side cannot reach this room; a test walks the imports to prove it.
"""
