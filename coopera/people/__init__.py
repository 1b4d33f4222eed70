"""Who lives: people that ship, people imported from conversations, logs of real people, a person at the terminal."""
