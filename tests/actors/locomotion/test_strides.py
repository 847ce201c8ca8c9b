import numpy as np

from esplanade.actors.locomotion._stride_kernels import fill_keys, go_on
from esplanade.actors.locomotion.footfalls import Footfalls
from esplanade.actors.locomotion.motion import KEYS, PELVIS, WIDTH, Floats, between
from esplanade.actors.locomotion.planted import step_targets
from esplanade.actors.locomotion.strides import Drawn, shifted, standing_keys, strides
from tests.naive import steps as naive

SHARES = np.linspace(0.0, 1.0, KEYS)


def some_falls(count: int) -> Footfalls:
    random = np.random.default_rng(5)
    right = np.arange(count) % 2 == 0
    side = np.where(right, 1.0, -1.0)
    standing = np.zeros((count, 4))
    standing[:, 3] = random.uniform(-9.0, 9.0, count)
    feet = []
    for ahead in (random.uniform(-0.6, 0.1, count), random.uniform(-0.1, 0.6, count)):
        foot = standing.copy()
        h, across = standing[:, 3], side * random.uniform(0.15, 0.3, count)
        foot[:, 0] += ahead * np.cos(h) - across * np.sin(h)
        foot[:, 1] += ahead * np.sin(h) + across * np.cos(h)
        foot[:, 3] += random.uniform(-0.3, 0.3, count)
        feet.append(foot)
    return Footfalls(right, feet[0], standing, feet[1], random.uniform(0.8, 0.95, count))


def some_drawn(keys: Floats) -> Drawn:
    """Something near the first key, on the move; every other pelvis with the other sign."""
    random = np.random.default_rng(6)
    key = keys[:, 0] + 0.02 * random.normal(size=(len(keys), WIDTH))
    key[::2, PELVIS] *= -1.0
    return Drawn(key, 0.01 * random.normal(size=(len(keys), WIDTH)))


def test_kernels_agree_with_their_plain_twins() -> None:
    falls = some_falls(9)
    targets = step_targets(falls, SHARES)
    keys = np.empty((9, KEYS, WIDTH))
    fill_keys(targets, falls, keys)
    plain = naive.keys_of(targets, falls)
    np.testing.assert_allclose(keys, plain, atol=1e-12)

    now = some_drawn(keys)
    ticks, goes_on = np.arange(9) + 4, np.arange(9) % 3 == 0
    aside = np.random.default_rng(7).normal(size=(9, 2)) * 0.1
    bent = naive.go_on(keys, now, goes_on, ticks, aside)
    go_on(keys, now.key.copy(), now.speed.copy(), goes_on, ticks, aside)
    np.testing.assert_allclose(keys, bent, atol=1e-12)


def test_a_step_goes_on_from_what_is_drawn_in_place_and_speed() -> None:
    falls = some_falls(8)
    now = some_drawn(standing_keys(falls))
    now.speed[:, PELVIS] = 0.0
    now.key[:, PELVIS] /= np.linalg.norm(now.key[:, PELVIS], axis=1, keepdims=True)
    ticks = np.full(8, 9)
    gone = np.full(8, 0.4)
    place = falls.landing[:, :2]
    keys, lift = strides(falls, gone, now, ticks, place, np.full(8, 0.1))
    body = [0, 1, 2, 7, 8, 9, 10, 11]
    start = between(keys, np.zeros(8))
    np.testing.assert_allclose(start[:, body], now.key[:, body], atol=1e-12)
    step = 1e-6
    slope = (between(keys, np.full(8, step)) - start) / step
    np.testing.assert_allclose(slope[:, body], 9.0 * now.speed[:, body], atol=1e-4)
    assert ((lift >= 0.0) & (lift < 1.0)).all()


def test_hips_end_where_they_should_within_their_room() -> None:
    falls = some_falls(6)
    now = Drawn(standing_keys(falls)[:, 0], np.zeros((6, WIDTH)))
    gone, ticks = np.zeros(6), np.full(6, 10)
    free, _ = strides(falls, gone, now, ticks, np.zeros((6, 2)), np.zeros(6))
    ends = free[:, -1, :2] + falls.standing[:, :2]
    asked = ends + np.array([0.06, -0.08])
    near, _ = strides(falls, gone, now, ticks, asked, np.full(6, 0.2))
    np.testing.assert_allclose(near[:, -1, :2] + falls.standing[:, :2], asked, atol=1e-12)
    far, _ = strides(falls, gone, now, ticks, asked, np.full(6, 0.05))
    moved = far[:, -1, :2] - free[:, -1, :2]
    np.testing.assert_allclose(np.hypot(moved[:, 0], moved[:, 1]), 0.05, atol=1e-12)


def test_who_shifts_keeps_both_feet_where_they_are() -> None:
    falls = some_falls(4)._replace()
    falls = falls._replace(landing=falls.lifted)
    still = standing_keys(falls)
    places = np.full((4, 2), 0.03)
    keys = shifted(Drawn(still[:, 0], np.zeros((4, WIDTH))), falls, places)
    np.testing.assert_allclose(keys[:, 0, :7], still[:, 0, :7])
    np.testing.assert_allclose(keys[:, -1, :2] + falls.standing[:, :2], places, atol=1e-12)
    assert (keys[..., 7:10] == 0.0).all()
