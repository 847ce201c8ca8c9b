"""The command on recorded crowds: it says how a file is read, and draws it."""
