"""The login of a process at a broker, and whom it trusts to be one."""

import ssl
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Self

USER_VARIABLE: Final = "ESPLANADE_NATS_USER"
PASSWORD_VARIABLE: Final = "ESPLANADE_NATS_PASSWORD"  # noqa: S105 (the name of a variable)
MOST_BYTES: Final = 4096
"""A longer file is no login."""


@dataclass(frozen=True)
class BrokerLogin:
    """A user with a password, and certificates; neither is told in logs."""

    user: str = ""
    password: str = field(default="", repr=False)
    authority: Path | None = None
    """The certificates that brokers are trusted by, PEM; None: those that the system trusts."""
    certificate: Path | None = None
    key: Path | None = field(default=None, repr=False)
    """The certificate by which a broker knows this process, and its key, PEM."""

    @classmethod
    def of(
        cls,
        environment: Mapping[str, str],
        file: Path | None,
        authority: Path | None = None,
        certificate: Path | None = None,
        key: Path | None = None,
    ) -> Self:
        """The login that a file says, on a line each the user and the password; without a file, the
        variables of the environment.

        Raises
        ------
        ValueError
            It says none, or a certificate and its key do not come together; no secret is told.
        """
        if (certificate is None) != (key is None):
            raise ValueError("nats_cert and nats_key: give both of them, or none")
        user, password = environment.get(USER_VARIABLE, ""), environment.get(PASSWORD_VARIABLE, "")
        if file is not None:
            try:
                lines = file.read_bytes()[: MOST_BYTES + 1].decode().splitlines()
            except (OSError, UnicodeDecodeError) as error:
                why = getattr(error, "strerror", None) or "it is no text"
                raise ValueError(f"nats_login: {file}: cannot be read: {why}") from None
            if len(lines) != 2 or not all(lines) or sum(map(len, lines)) > MOST_BYTES:
                raise ValueError(
                    f"nats_login: {file}: it has the user on its first line, the password on its "
                    "second, and no more"
                )
            user, password = lines
        if bool(user) != bool(password):
            raise ValueError(f"{USER_VARIABLE}, {PASSWORD_VARIABLE}: give both of them, or none")
        return cls(user, password, authority, certificate, key)

    def settings(self, servers: tuple[str, ...]) -> dict[str, Any]:
        """The settings of the library for these brokers.

        Raises
        ------
        OSError
            A certificate cannot be read, or is none.
        """
        found: dict[str, Any] = {}
        if self.user:
            found |= {"user": self.user, "password": self.password}
        encrypted = self.authority is not None or self.certificate is not None
        if encrypted or any(server.startswith("tls://") for server in servers):
            context = ssl.create_default_context(
                cafile=None if self.authority is None else str(self.authority)
            )
            if self.certificate is not None and self.key is not None:
                context.load_cert_chain(self.certificate, self.key)
            found["tls"] = context
        return found


ANYBODY: Final = BrokerLogin()
"""The login at a broker that lets everybody in."""
