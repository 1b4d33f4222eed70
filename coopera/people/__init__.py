"""The people of a run: personas that ship and personas imported from conversations.

Real people are here, too: by their log, or at the terminal.
"""
