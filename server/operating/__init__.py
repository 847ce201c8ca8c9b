"""The commands by which a machine's owner sees to operators and data: `esplanade op` and `data`.

They work on the store itself, whether a server runs on it or not.
"""
