"""What small language models need: weights out of a package, texts that do not repeat themselves, short replies."""
