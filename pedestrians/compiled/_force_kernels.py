"""The forces that drive one person aside: by another body, and by a wall."""

import math

from esplanade.pedestrians.compiled.records import Numbers
from esplanade.planning.compiled.arrays import Bools, Floats
from esplanade.planning.compiled.jit import kernel

PEOPLE_CONTACT_M = 0.5
"""The distance of two people's centres when they touch."""
SAME_PLACE_M = 1e-9
"""Bodies nearer to each other than this have no direction from one to the other."""
STANDING_MPS = 0.05
"""A slower person than this looks around, and has nobody behind."""


@kernel
def evasion(
    to_x: float,
    to_y: float,
    vx: float,
    vy: float,
    other_vx: float,
    other_vy: float,
    wider_m: float,
    numbers: Numbers,
) -> tuple[float, float]:
    """Acceleration by which a person evades another body, for a strength A of 1.

    Parameters
    ----------
    to_x, to_y : metres
        From the person to the other body.
    vx, vy, other_vx, other_vy : m/s
        Velocities of both.
    wider_m : metres
        How much wider the other body is than a person: it counts as nearer by this, and its
        angle as smaller in proportion to the distance at which both would touch. Ours.

    Notes
    -----
    Moussaïd et al. 2009: with the unit vector e to the other and D = λ (v - v') + e, t is the
    direction of D, B = γ |D|, θ the angle from t to e plus B ε, and the acceleration
    f / A = -exp(-d/B - (n'Bθ)²) t - sign(θ) exp(-d/B - (nBθ)²) n, where n is to the left of t.
    ε makes those who meet head-on turn to the right. What is out of sight, beyond an angle around
    the direction of walking, counts less: w(e, f) of Helbing & Molnár 1995.
    """
    away_m = math.hypot(to_x, to_y)
    if away_m < SAME_PLACE_M:
        return 0.0, 0.0
    ex, ey = to_x / away_m, to_y / away_m
    dx = numbers.velocity_share_s * (vx - other_vx) + ex
    dy = numbers.velocity_share_s * (vy - other_vy) + ey
    length = math.hypot(dx, dy)
    if length < SAME_PLACE_M:
        return 0.0, 0.0
    tx, ty = dx / length, dy / length
    reach_m = numbers.reach_m * length
    angle = math.atan2(tx * ey - ty * ex, tx * ex + ty * ey)
    angle *= PEOPLE_CONTACT_M / (PEOPLE_CONTACT_M + wider_m)
    angle += reach_m * numbers.side_bias_per_m
    near = math.exp(-max(0.0, away_m - wider_m) / reach_m)
    slower = near * math.exp(-((numbers.slowing_per_m * reach_m * angle) ** 2))
    aside = near * math.exp(-((numbers.turning_per_m * reach_m * angle) ** 2))
    aside = math.copysign(aside, angle)
    weight = 1.0
    speed = math.hypot(vx, vy)
    if speed > STANDING_MPS and vx * ex + vy * ey < speed * numbers.sight_cosine:
        weight = numbers.unseen
    return -weight * (slower * tx - aside * ty), -weight * (slower * ty + aside * tx)


@kernel
def nearest_on_walls(
    x: float, y: float, walls: Floats, passes: Bools, numbers: Numbers
) -> tuple[float, float, float]:
    """From the nearest wall to a point: direction (x, y), and distance in metres.

    Walls that do not count for the person (`passes`) are left out. The distance is infinite if
    none is within reach.
    """
    best = numbers.wall_range_m**2
    found_x, found_y, found_m = 0.0, 0.0, math.inf
    for m in range(walls.shape[0]):
        if passes[m]:
            continue
        ax, ay, bx, by = walls[m, 0], walls[m, 1], walls[m, 2], walls[m, 3]
        along_x, along_y = bx - ax, by - ay
        square = max(along_x * along_x + along_y * along_y, 1e-12)
        share = ((x - ax) * along_x + (y - ay) * along_y) / square
        share = min(1.0, max(0.0, share))
        from_x, from_y = x - (ax + share * along_x), y - (ay + share * along_y)
        d2 = from_x * from_x + from_y * from_y
        if d2 < best:
            best = d2
            found_m = math.sqrt(d2)
            found_x, found_y = from_x, from_y
    if found_m < math.inf and found_m > SAME_PLACE_M:
        return found_x / found_m, found_y / found_m, found_m
    return 0.0, 0.0, found_m


@kernel
def wall_push(
    x: float, y: float, walls: Floats, passes: Bools, numbers: Numbers
) -> tuple[float, float]:
    """Acceleration away from the nearest wall: a exp(-d/b), Moussaïd et al. 2009."""
    from_x, from_y, away_m = nearest_on_walls(x, y, walls, passes, numbers)
    if away_m == math.inf:
        return 0.0, 0.0
    push = numbers.wall_strength_mps2 * math.exp(-away_m / numbers.wall_reach_m)
    return push * from_x, push * from_y


@kernel
def beyond(ax: float, ay: float, rx: float, ry: float) -> tuple[float, float]:
    """The part of what acts now (ax, ay) that did not act in the recording (rx, ry).

    Of the recorded part no more is taken off than acts now: where nobody is any more, nothing
    draws a person there.
    """
    recorded = math.hypot(rx, ry)
    if recorded == 0.0:
        return ax, ay
    share = min(1.0, math.hypot(ax, ay) / recorded)
    return ax - share * rx, ay - share * ry


@kernel
def first_wall(
    x: float, y: float, step: Floats, walls: Floats, passes: Bools, margin_m: float
) -> int:
    """The first wall that a step (2,) from a point, made longer by a margin, meets; -1 if none."""
    length = math.hypot(step[0], step[1])
    if length < 1e-12:
        return -1
    longer = 1.0 + margin_m / length
    dx, dy = step[0] * longer, step[1] * longer
    found, best = -1, 2.0
    for m in range(walls.shape[0]):
        if passes[m]:
            continue
        ex, ey = walls[m, 2] - walls[m, 0], walls[m, 3] - walls[m, 1]
        cross = dx * ey - dy * ex
        if abs(cross) < 1e-15:
            continue
        ox, oy = walls[m, 0] - x, walls[m, 1] - y
        on_step = (ox * ey - oy * ex) / cross
        on_wall = (ox * dy - oy * dx) / cross
        if 0.0 <= on_step <= 1.0 and 0.0 <= on_wall <= 1.0 and on_step < best:
            best = on_step
            found = m
    return found


@kernel
def slide(x: float, y: float, step: Floats, walls: Floats, passes: Bools, margin_m: float) -> None:
    """Turn a step (2,) along the walls that it would cross; it becomes 0 in a corner."""
    for _ in range(2):
        wall = first_wall(x, y, step, walls, passes, margin_m)
        if wall < 0:
            return
        ex, ey = walls[wall, 2] - walls[wall, 0], walls[wall, 3] - walls[wall, 1]
        share = (step[0] * ex + step[1] * ey) / (ex * ex + ey * ey)
        step[0], step[1] = share * ex, share * ey
    if first_wall(x, y, step, walls, passes, margin_m) >= 0:
        step[0], step[1] = 0.0, 0.0
