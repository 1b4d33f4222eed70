"""What a notebook shows of an object: small pieces of HTML that carry their own looks and load nothing.

All text is escaped; what an object is made of comes from runs, which anybody may have written.
"""
