"""What changes the home: walking, taking, putting, handing over, motions, and the state that they leave behind.

A plan of an act is made and checked here before the world carries it out; predicates read the state.
"""
