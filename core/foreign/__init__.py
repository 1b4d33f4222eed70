"""Files that somebody else has made, each kind read in one place, within limits of size, count and depth.

docs/security.md lists the limits. YAML is read by `coopera.core.strict_yaml`; meshes by `coopera.simulation.homes`.
"""
