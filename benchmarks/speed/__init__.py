"""How fast is coopera? `python -m benchmarks.speed` measures, and writes docs/performance.md."""
