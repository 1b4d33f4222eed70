"""Controls and ceilings: methods that say what help there is without a model, and how much there could be.

Each is one file with its robot and its `Method`; `evaluation.methods` lists them among the others.
"""
