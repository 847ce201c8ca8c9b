"""Steps made up for tests: nobody would walk so, but every field has a value of its own."""

import numpy as np

from esplanade.protocol.keys_between import KEYS
from esplanade.protocol.quaternions import Floats, from_angles, from_twist
from esplanade.protocol.steps import Footprints, Keys, StepRecords, Steps


def made_up_steps(count: int, seed: int = 0) -> Steps:
    """Random steps, all values within the range of a record; the swing foot lands on its place."""
    random = np.random.default_rng(seed)

    def within(low: float, high: float, *shape: int) -> Floats:
        return random.uniform(low, high, (count, *shape))

    landing = Footprints(within(-300.0, 300.0, 3), within(0.0, 2.0 * np.pi))
    standing = Footprints(landing.positions_m + within(-1.0, 1.0, 3), within(-9.0, 9.0))
    yaws, trunks = within(-3.1, 3.1, KEYS, 1), within(-0.2, 0.2, KEYS, 2)
    angles = np.concatenate([yaws, trunks], axis=-1)
    ankles_m = landing.positions_m[:, None] + within(-3.2, 3.2, KEYS, 3)
    swing_headings_rad = landing.headings_rad[:, None] + within(-3.0, 3.0, KEYS)
    ankles_m[:, -1], swing_headings_rad[:, -1] = landing.positions_m, landing.headings_rad
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
            pelvises=from_angles(angles),
            ankles_m=ankles_m,
            swing_pitches_rad=within(-3.0, 3.0, KEYS),
            standing_pitches_rad=within(-3.0, 3.0, KEYS),
            swing_headings_rad=swing_headings_rad,
            chests=from_twist(within(-0.2, 0.2, KEYS), angles[..., 2]),
            arms_rad=within(-1.5, 1.5, KEYS, 4),
        ),
        flights=within(0.0, 0.49),
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
