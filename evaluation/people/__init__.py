"""Checks on the simulated person (PAPER §4.2): are people distinct, diverse, coherent, consistent in time, lifelike?"""
