"""One world on several machines: which host owns a zone, and where each person's seat is.

PostgreSQL is the only truth; everything else may be lost, doubled or late. The modules of rules
(`tenure`, `frame_gate`, `occupations`, `hops`) are plain classes that know no clock, network or
database: what they decide follows from what they are told. `ownership` and `seats` are the truth,
as statements of one transaction each.
"""
