"""Human verification: what raters are shown of runs, who rates what, and what comes of it.

How far they agree is measured here, too.
"""
