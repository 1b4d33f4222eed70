"""What people look at: the report's page, its charts and films, an hour as a tree, tables, progress in a terminal."""
