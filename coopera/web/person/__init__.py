"""The person's page: somebody lives the day in the browser while the run waits for them."""
