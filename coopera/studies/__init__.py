"""Running: a configuration completed from what there is, wired to services, lived as one study or several at once."""
