"""Evaluation of navigation and prediction among recorded people, who do not react."""
