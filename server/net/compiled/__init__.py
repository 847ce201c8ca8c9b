"""Compiled code of the server that writes frames; it takes nothing but from the live world's."""
