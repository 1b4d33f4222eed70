"""What small language models need: weights out of a package, texts that do not repeat themselves, short replies.

Nothing here knows of prompts, roles or servers. The settings are among those of all models' calls.
"""
