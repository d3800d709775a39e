"""What a person looks at: report, plots and films."""
