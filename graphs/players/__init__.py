"""Who plays the person: the simulation and its models of a person, a real person's log, or somebody who is asked.

All implement one protocol, `player.Player`; the human graph's variables and checks of tasks are here, too.
"""
