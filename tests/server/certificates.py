"""Certificates for tests, made by OpenSSL's command."""

import ssl
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Pair:
    """A certificate that signs itself, for localhost and 127.0.0.1, and its key."""

    cert: Path
    key: Path

    @property
    def settings(self) -> dict[str, Path]:
        return {"tls_cert": self.cert, "tls_key": self.key}

    def trusting(self) -> ssl.SSLContext:
        """The context of a client that trusts this certificate only."""
        return ssl.create_default_context(cafile=self.cert)

    def replace_by(self, other: "Pair") -> None:
        """Have the files of another pair at the places of this one, one after the other."""
        other.cert.replace(self.cert)
        other.key.replace(self.key)


def make_pair(folder: Path, name: str, kind: str = "ec") -> Pair:
    """A new pair of the kind `ec` or `rsa`, in files of that name."""
    cert, key = folder / f"{name}.pem", folder / f"{name}.key"
    kinds = {"ec": ("ec", "-pkeyopt", "ec_paramgen_curve:prime256v1"), "rsa": ("rsa:2048",)}
    openssl(
        *("req", "-x509", "-nodes", "-days", "2", "-subj", "/CN=localhost", "-newkey"),
        *kinds[kind],
        *("-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"),
        *("-keyout", str(key), "-out", str(cert)),
    )
    return Pair(cert, key)


def openssl(*arguments: str) -> None:
    subprocess.run(["openssl", *arguments], check=True, capture_output=True)
