"""Whether something will work, before it is run: a model, a household file, a method; and what a run will cost."""
