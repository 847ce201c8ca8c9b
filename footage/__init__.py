"""Pictures of walking: strips, films, plots, and the cycle of figures that are far away."""
