"""The offline model as the robot: what it guesses from what it saw and was told, and what it believes of the person."""
