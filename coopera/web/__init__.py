"""Pages that a small server shows in the browser: one design, one door, one folder for each kind of page."""
