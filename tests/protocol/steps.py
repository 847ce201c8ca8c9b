"""Steps made up for tests: nobody would walk so, but every field has a value of its own."""

import numpy as np

from esplanade.protocol.steps import KEYS, Floats, Footprints, Keys, StepRecords, Steps


def made_up_steps(count: int, seed: int = 0) -> Steps:
    """Random steps, all values within the range of a record."""
    random = np.random.default_rng(seed)

    def within(low: float, high: float, *shape: int) -> Floats:
        return random.uniform(low, high, (count, *shape))

    landing = Footprints(within(-300.0, 300.0, 3), within(0.0, 2.0 * np.pi))
    standing = Footprints(landing.positions_m + within(-1.0, 1.0, 3), within(-9.0, 9.0))
    return Steps(
        ids=random.integers(0, 2**32, count),
        on_right=random.random(count) < 0.5,
        re_aimed=random.random(count) < 0.5,
        begin_ticks=random.integers(0, 2**32, count),
        durations_ticks=random.integers(0, 256, count),
        standing=standing,
        landing=landing,
        lifts=within(0.0, 1.0),
        keys=Keys(
            roots_m=standing.positions_m[:, None] + within(-3.2, 3.2, KEYS, 3),
            pelvises=_unit(random.normal(size=(count, KEYS, 4))),
            ankles_m=landing.positions_m[:, None] + within(-3.2, 3.2, KEYS, 3),
            swing_pitches_rad=within(-3.0, 3.0, KEYS),
            standing_pitches_rad=within(-3.0, 3.0, KEYS),
            swing_headings_rad=landing.headings_rad[:, None] + within(-3.0, 3.0, KEYS),
            chests=_unit(within(-0.3, 0.3, KEYS, 4) + np.array([1.0, 0.0, 0.0, 0.0])),
            arms_rad=within(-3.0, 3.0, KEYS, 4),
        ),
    )


def mixed_block(records: StepRecords) -> bytes:
    """A block as a later version may send it: other kinds, and walking steps with more at the end.

    It begins with the first of the records (N,) and ends with the last.
    """
    of_other_kinds = [b"\x02\x03\x00", b"\x07\x05\x00\x01\x01", b"\xff\x04\x01" + bytes(257)]
    parts = [records[0].tobytes()]
    for place, record in enumerate(records[1:]):
        parts.append(of_other_kinds[place % 3])
        longer = record.copy()
        longer["length"] += place
        parts.append(longer.tobytes() + b"\x55" * place)
    parts[-1] = records[-1].tobytes()
    return b"".join(parts)


def _unit(quaternions: Floats) -> Floats:
    unit: Floats = quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True)
    return unit
