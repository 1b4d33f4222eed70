"""The rating page: people say yes or no to what robots proposed, without knowing which robot it was.

What they are shown, and what comes of it, is in `coopera.evaluation.rating`; here are the files and the pages.
"""
