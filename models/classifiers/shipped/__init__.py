"""The classifiers that ship: each file here is one, found by its name (`coopera.models.classifiers.registry`)."""
