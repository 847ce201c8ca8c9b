"""Lines to policies from outside, which are asked and waited for: a process, or a socket."""

import contextlib
import os
import selectors
import signal
import socket
import subprocess
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, Final

from esplanade.policies.errors import PolicyFaultError
from esplanade.policies.messages import (
    LONGEST_ANSWER,
    MessageError,
    line_of,
    message_of,
)

_HOST: Final = "esplanade.policies.host"


class PolicyLine(ABC):
    """A line to a policy, which answers one question at a time."""

    def __init__(self, questions: int, answers: int) -> None:
        """`questions` and `answers` are descriptors of open files, which may be one."""
        self._questions, self._answers = questions, answers
        for each in (questions, answers):
            os.set_blocking(each, False)
        self._read = b""

    def ask(self, message: Mapping[str, Any], within_s: float) -> dict[str, Any]:
        """The answer to a question.

        Raises
        ------
        PolicyFaultError
            There is none in time, it is an error, or it is no answer. The line is to be closed.
        """
        deadline_s = time.monotonic() + within_s
        try:
            self._write(line_of(message), deadline_s)
            found = message_of(self._line(deadline_s))
        except TimeoutError:
            raise PolicyFaultError(f"it did not answer within {within_s:g} s") from None
        except (OSError, EOFError):
            raise PolicyFaultError(self._ended()) from None
        except MessageError as error:
            raise PolicyFaultError(f"its answer {error}") from None
        if "error" in found:
            raise PolicyFaultError(str(found["error"]))
        return found

    @abstractmethod
    def end(self) -> None:
        """End the other end, so that whoever waits for an answer learns of it."""

    @abstractmethod
    def close(self) -> None:
        """End the line. It is not used afterwards, and nobody may wait for an answer."""

    @abstractmethod
    def _ended(self) -> str:
        """How the other end came to end the line."""

    def _write(self, data: bytes, deadline_s: float) -> None:
        while data:
            try:
                data = data[os.write(self._questions, data) :]
            except BlockingIOError:
                _wait(self._questions, selectors.EVENT_WRITE, deadline_s)

    def _line(self, deadline_s: float) -> bytes:
        while b"\n" not in self._read:
            if len(self._read) > LONGEST_ANSWER:
                raise MessageError(f"is longer than {LONGEST_ANSWER} bytes")
            _wait(self._answers, selectors.EVENT_READ, deadline_s)
            more = os.read(self._answers, 1 << 16)
            if not more:
                raise EOFError
            self._read += more
        line, _, self._read = self._read.partition(b"\n")
        return line


class PolicyProcess(PolicyLine):
    """A process of a policy. It ends with `close`, or when this process ends."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", _HOST]
        (questions, self._asks), (self._answered, answers) = os.pipe(), os.pipe()
        self._process = subprocess.Popen(
            command, stdin=questions, stdout=answers, start_new_session=True
        )
        os.close(questions)
        os.close(answers)
        super().__init__(self._asks, self._answered)

    def end(self) -> None:
        """End the process, with all that it has started."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def close(self) -> None:
        """End the process, with all that it has started."""
        os.close(self._asks)
        os.close(self._answered)
        self.end()
        self._process.wait()

    def _ended(self) -> str:
        try:
            code = self._process.wait(1.0)
        except subprocess.TimeoutExpired:
            return "it closed its output"
        return f"its process ended {f'by signal {-code}' if code < 0 else f'with code {code}'}"


class PolicySocket(PolicyLine):
    """A line to a policy that listens on a TCP port, in whatever language.

    Raises
    ------
    OSError
        Nobody listens there.
    """

    def __init__(self, host: str, port: int, within_s: float) -> None:
        self._socket = socket.create_connection((host, port), within_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        super().__init__(self._socket.fileno(), self._socket.fileno())

    def end(self) -> None:
        """Let nobody send any more."""
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Hang up."""
        self._socket.close()

    def _ended(self) -> str:
        return "it hung up"


def _wait(pipe: int, event: int, deadline_s: float) -> None:
    """Wait until a descriptor is ready.

    Raises
    ------
    TimeoutError
        It is not until then.
    """
    with selectors.DefaultSelector() as selector:
        selector.register(pipe, event)
        if not selector.select(max(0.0, deadline_s - time.monotonic())):
            raise TimeoutError
