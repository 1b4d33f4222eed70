"""Acts, which change the home: walking, taking, putting, opening, handing over, making a motion.

A plan of an act is made and checked here before the world carries it out.
"""
