"""Answers of a zone for single people, gathered in a tick and sent to the gateways of each."""

from collections import defaultdict
from typing import Final

import structlog
from nats.aio.client import Client
from nats.errors import Error as NatsError

from esplanade.protocol import CloseCode, ProtocolError
from esplanade.protocol.messages import Error, FromServer
from esplanade.server.link.answers import Answer, encode_answers
from esplanade.server.link.subjects import Subjects
from esplanade.server.net import frames

MOST_WAITING: Final = 2048
"""Of one gateway; whatever is answered beyond them in one tick is left out."""

log = structlog.get_logger(__name__)


class Answering:
    """Takes answers for people, and sends those of a tick together."""

    def __init__(self, broker: Client, subjects: Subjects, zone: str) -> None:
        self._broker = broker
        self._subjects = subjects
        self._zone = zone
        self._waiting: defaultdict[str, list[Answer]] = defaultdict(list)
        self.left_out = 0
        """Answers that did not go out, since there were too many or the broker was away."""

    def post(self, gateway: str, person: int, generation: int, message: FromServer) -> None:
        """Tell somebody something."""
        self._put(gateway, Answer(person, generation, frames.message(message)))

    def tell(self, gateway: str, person: int, generation: int, fault: ProtocolError) -> None:
        """Tell somebody of a fault in what they have sent."""
        error = Error(error=fault.code, text=fault.text, arguments=fault.arguments)
        self.post(gateway, person, generation, error)

    def pass_on(self, gateway: str, person: int, generation: int, frame: bytes) -> None:
        """Send somebody a frame."""
        self._put(gateway, Answer(person, generation, frame))

    def dismiss(
        self,
        gateway: str,
        person: int,
        generation: int,
        frame: bytes,
        close: CloseCode,
        reason: str,
    ) -> None:
        """End the connection of somebody, with a last frame."""
        self._put(gateway, Answer(person, generation, frame, close, reason))

    def replaced(self, gateway: str, person: int, generation: int) -> None:
        """Let a gateway know that somebody has taken a seat since."""
        self._put(gateway, Answer(person, generation, b""))

    async def send(self) -> None:
        """Send what was answered since the last call."""
        waiting, self._waiting = self._waiting, defaultdict(list)
        for gateway, answers in waiting.items():
            if not self._broker.is_connected:
                self.left_out += len(answers)
                continue
            try:
                for message in encode_answers(self._zone, answers):
                    await self._broker.publish(self._subjects.gateway(gateway), message)
            except NatsError as error:
                self.left_out += len(answers)
                log.debug("answers were not sent", gateway=gateway, error=str(error))

    def _put(self, gateway: str, answer: Answer) -> None:
        if len(self._waiting[gateway]) < MOST_WAITING:
            self._waiting[gateway].append(answer)
        else:
            self.left_out += 1
