"""The parts of the benchmark `gpu.py`."""
