"""The classifiers that ship. Each file here is one, found by its name (`coopera.models.classifiers.registry`)."""
