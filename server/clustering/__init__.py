"""The commands of a world on several machines: `esplanade zone`, `gateway` and `cluster`."""
