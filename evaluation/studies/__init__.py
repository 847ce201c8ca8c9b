"""Studies that compare variants of our actor on the same episodes: sensitivity and tuning."""
