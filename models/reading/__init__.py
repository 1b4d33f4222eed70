"""How a model's reply is read: tolerant of its form, never of its meaning.

`loose_json` reads JSON as models write it, `fitting` brings it into the form of the schema, `names` finds the object
that a name means, and `words` knows what models say for yes, nothing and numbers. `coopera.models.parsing` puts them
together.
"""
