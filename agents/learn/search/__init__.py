"""The search for hyper-parameters: trials of equal processor time, side by side."""
