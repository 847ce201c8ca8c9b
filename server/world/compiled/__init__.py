"""Compiled code of the live world; it takes nothing but from planning and locomotion."""
