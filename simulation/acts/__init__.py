"""Acts, which change the home: walking, taking, putting, handing over, making a motion.

A plan of an act is made and checked here before the world carries it out; predicates read the state.
"""
