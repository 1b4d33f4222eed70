"""Homes of ProcTHOR: house JSON as it is published, read, understood and drawn from our own shapes or as boxes."""
