"""Controls and ceilings: methods that say what help there is without a model, and how much there could be."""
