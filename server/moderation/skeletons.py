"""Skeletons of names and words: the form that texts which look alike have in common.

Two look alike if they have one skeleton of Unicode Technical Standard 39. The library makes
it without regard to case and folds digits to the letters that they look like. It keeps "rn" and
"m" apart, which the standard does not.
"""

import disarm


def skeleton(name: str) -> str:
    """The form that names which look alike have in common; for comparing, not for showing."""
    folded = disarm.skeleton_key(name, digit_policy="tr39").replace("rn", "m")
    return folded or name
