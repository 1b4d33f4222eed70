"""Running a study: the configuration is completed, the services are opened, and the study graph runs.

Several studies run at once here, and a run's acts are replayed.
"""
