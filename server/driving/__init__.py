"""Policies from outside drive actors of a served zone, beside those that plan by themselves."""
