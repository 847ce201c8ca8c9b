"""Hatchling hook: a wheel of Esplanade carries the built web client.

It builds `client_web` into `server/client_assets` with the Node.js that comes from PyPI. Editable
installs leave the client alone: there `make client` builds it when its sources change.
"""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SKIP_VARIABLE = "ESPLANADE_SKIP_CLIENT"
PAGE = "src/esplanade/server/client_assets/index.html"


class ClientBuildHook(BuildHookInterface):  # type: ignore[type-arg]  # its configuration is unused
    """Builds the web client before the files of a wheel are collected."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Build the client, unless the install is editable or the variable says to skip it."""
        if self.target_name != "wheel" or version == "editable":
            return
        if os.environ.get(SKIP_VARIABLE) == "1":
            self.app.display_warning(f"{SKIP_VARIABLE}=1: the web client is not built")
            return
        self._npm("ci", "--include=dev", "--no-audit", "--no-fund")
        self._npm("run", "build")
        page = Path(self.root, PAGE)
        if not page.is_file():
            self.app.abort(f"The web client's build ended well but left no {page}.")

    def _npm(self, *arguments: str) -> None:
        command = [sys.executable, str(Path(self.root, "tools", "npm.py")), *arguments]
        status = subprocess.run(command, check=False).returncode
        if status != 0:
            self.app.abort(
                f"Building the web client failed: `npm {' '.join(arguments)}` in client_web ended "
                f"with status {status}; its output is above. It needs the npm registry. To install "
                f"without the web client, set {SKIP_VARIABLE}=1."
            )
