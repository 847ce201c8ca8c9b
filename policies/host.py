"""The process in which a policy from outside runs; this module is its program.

It reads questions from its input and writes answers to its output, one JSON object a line; see
`messages`. What the policy prints goes to the standard error. Nothing of a recording is ever in
this process but what the robot has seen.
"""

import os
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any, Final

from esplanade.policies.messages import (
    DECISIONS,
    line_of,
    message_of,
    observation_of,
    task_of,
)
from esplanade.policies.names import maker_of

_HERE: Final = str(Path(__file__).parent)


class Host:
    """Answers the questions to one policy."""

    def __init__(self) -> None:
        self._policy: Any = None

    def answer(self, message: Mapping[str, Any]) -> dict[str, Any]:
        """The answer to a question; the errors of the policy are not caught."""
        match message["ask"]:
            case "load":
                self._policy = maker_of(message["policy"])(**message["options"])
                decides = [n for n in DECISIONS if callable(getattr(self._policy, n, None))]
                if not decides:
                    raise TypeError("it has no method velocity(observation)")
                return {"ready": True, "decides": decides}
            case "reset":
                if hasattr(self._policy, "reset"):
                    self._policy.reset(task_of(message["task"]))
            case "velocity":
                seen = observation_of(message["observation"])
                return {"velocity": _listed(self._policy.velocity(seen))}
            case "goal":
                seen = observation_of(message["observation"])
                return {"goal": _listed(self._policy.goal(seen))}
            case "explain":
                told = self._policy.explain() if hasattr(self._policy, "explain") else None
                return {name: _listed(value) for name, value in (told or {}).items()}
        return {"ready": True}


def _listed(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else value


def _fault(error: BaseException) -> str:
    """An error in a line: what it is, and the newest place in the policy's own code."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if not _is_ours(f.filename)]
    where = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    text = str(error.args[0]) if type(error) is LookupError else f"{type(error).__name__}: {error}"
    return text[:500].replace("\n", " ") + where


def _is_ours(file: str) -> bool:
    return file.startswith((_HERE, "<frozen"))


def serve(questions: IO[bytes], answers: IO[bytes]) -> None:
    """Answer until there are no more questions."""
    host = Host()
    for line in questions:
        try:
            reply = line_of(host.answer(message_of(line)))
        except KeyboardInterrupt:
            return
        except BaseException as error:  # noqa: BLE001 - whatever a policy does is its own fault
            reply = line_of({"error": _fault(error)})
        answers.write(reply)
        answers.flush()


def main() -> None:
    """Serve the pipes that the process began with, out of the policy's reach."""
    questions, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    serve(questions, answers)


if __name__ == "__main__":
    main()
