"""Recordings of a zone: all inputs of its ticks, from which it is run again bit for bit."""
