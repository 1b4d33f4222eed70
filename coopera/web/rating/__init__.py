"""The rating page: people say yes or no to what robots proposed, without knowing which robot it was."""
