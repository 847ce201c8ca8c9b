"""The command line of all commands: options, environment, faults, exit codes, progress, tables.

Importing this package imports nothing else, and each file imports only what it needs: a command
explains itself and refuses a wrong option before anything heavy is loaded.
"""
