"""Bars and lines that are seen while a command works."""

import io

import pytest
from rich.console import Console

from esplanade.commandline.progress import PLAIN_EVERY_S, StatusLine, progress


def test_bars_go_to_the_error_output(capsys: pytest.CaptureFixture[str]) -> None:
    for shown in (progress(), progress(share=True), progress(time_left=True)):
        assert shown.console.stderr
        with shown:
            shown.advance(shown.add_task("drawing", total=2))
    assert capsys.readouterr().out == ""


def test_without_a_terminal_a_line_comes_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("esplanade.commandline.progress.time.monotonic", lambda: now[0])
    out = io.StringIO()
    with StatusLine(Console(file=out)) as shown:
        for number in range(5):
            shown.show(f"line {number}")
            now[0] += PLAIN_EVERY_S / 2
    assert out.getvalue().split("\n")[:2] == ["line 2", "line 4"]
