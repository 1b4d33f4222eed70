"""Human verification: what raters are shown of runs, who rates what, how far they agree, and what comes of it."""
