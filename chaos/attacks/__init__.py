"""All attacks, a file for each kind; `catalogue.py` lists them."""
