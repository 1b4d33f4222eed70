"""What a run is told: the configuration with all its fields, and the strict reading and atomic writing of files."""
