"""Tries the environment with every trainer and every supported Gymnasium: `make compat`."""
