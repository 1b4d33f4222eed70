"""The person's page: somebody lives the day in the browser while the run waits for them.

`WebPerson` asks in place of the terminal, and `make_person_app` shows what it asks.
"""
