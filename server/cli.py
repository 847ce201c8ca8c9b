"""`esplanade serve`: runs the server, and says why it cannot."""

from argparse import Namespace

from esplanade.commandline import exit_codes, fields
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.settings import given_settings
from esplanade.server.loading import LoadingError
from esplanade.server.main import serve
from esplanade.server.net.tls import TlsError
from esplanade.server.options import SETTINGS
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import StoreError


def run(options: Namespace) -> int:
    """Run the server as the options say; returns the exit code."""
    settings = fields.made(ServerSettings, given_settings(options, SETTINGS))
    try:
        serve(settings)
    except (LoadingError, TlsError) as error:
        raise UsageError(str(error)) from None
    except StoreError as error:
        raise CommandError(str(error)) from None
    except OSError as error:
        ports = f"{settings.host}:{settings.port}, {settings.private_host}:{settings.private_port}"
        raise CommandError(f"cannot listen on {ports}: {error.strerror or error}") from None
    return exit_codes.OK
