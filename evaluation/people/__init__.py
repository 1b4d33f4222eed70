"""Checks on the simulated people (PAPER §4.2): are they distinct, diverse, coherent, consistent in time, lifelike?

The two user studies are made and scored here, too.
"""
