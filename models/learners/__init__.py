"""Learners of a person's ways from plain evidence: what is done when, what is chosen, and what belongs where.

They know nothing of homes, hours or robots. What they learn from is counts of exact identities and sentence embeddings,
and evidence from before a change of the person stops to count by itself.
"""
