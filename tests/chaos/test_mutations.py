"""Changed frames: the same from the same seed, of many kinds, and each refused by a name."""

from pathlib import Path

import pytest
from chaos import mutated
from chaos.mutated import completed, in_process, over_sockets
from chaos.mutations import Mutations
from chaos.wire import frame

from esplanade.protocol import ErrorCode


def test_seed_and_number_make_a_frame() -> None:
    one, same, other = Mutations(1), Mutations(1), Mutations(2)
    frames = [one.framed(k) for k in range(500)]
    assert frames == [same.framed(k) for k in range(500)]
    assert frames != [other.framed(k) for k in range(500)]
    assert len(set(frames)) > 450


def test_the_decoder_takes_a_changed_frame_or_refuses_it_by_name() -> None:
    tally = in_process(20_000, seed=5)
    assert tally.faults == []
    assert sum(tally.outcomes.values()) == tally.frames == 20_000
    assert set(tally.outcomes) == {"taken", ErrorCode.MALFORMED.value, ErrorCode.INVALID.value}


def test_any_other_error_of_the_decoder_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def faulty(frame: bytes) -> None:
        raise KeyError(frame[:1])

    monkeypatch.setattr(mutated, "decode_client", faulty)
    tally = in_process(10, seed=5)
    assert len(tally.faults) == tally.outcomes[mutated.UNNAMED] == 10
    assert "seed 5 number 0: KeyError" in tally.faults[0]
    assert not tally.passed


def test_frames_that_are_half_are_completed() -> None:
    whole = frame(b"12345")
    assert completed(whole) == whole
    assert completed(whole[:-2]) == whole[:-2] + bytes(2)
    assert completed(whole[:1]) == whole[:1] + bytes(1)
    # A frame that claims more than any may have is refused at its head.
    assert len(completed(b"\x82\xff" + b"\x7f" * 8)) < 1 << 16


def test_a_server_names_every_fault_of_changed_frames(tmp_path: Path) -> None:
    tally = over_sockets(300, seed=7, folder=tmp_path)
    assert tally.faults == []
    assert tally.frames == 300
    assert tally.passed
    assert {ErrorCode.MALFORMED.value, ErrorCode.INVALID.value, "taken"} <= set(tally.outcomes)
