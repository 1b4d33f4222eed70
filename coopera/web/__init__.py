"""Pages that a small server shows in the browser, in one design.

Each kind of page has a folder of its own; what they share is in `common`.
"""
