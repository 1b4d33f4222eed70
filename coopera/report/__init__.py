"""Views of a run for its reader: the report page with its charts and pictures.

In a terminal: an hour as a tree, tables, and progress.
"""
