"""Many variants of our actor on the same episodes: what each setting does, and which are best."""
