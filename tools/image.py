"""Builds the image without a container engine, and runs it until it is healthy.

    sudo python -m tools.image                     needs mmdebstrap and bubblewrap (apt)
    sudo python -m tools.image --bind /opt/wheels  lets steps see a mirror of this machine

The steps of the Dockerfile are run one by one, each within the folder of its stage: Debian with
its own Python stands in for the image that the file begins with. Then the last stage is run as its
user, its root folder read-only but for the volumes and /tmp, without any network but its own
loopback, until its health check passes; it has to end in order when it is told to.
"""

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from tools.dockerfile import DockerfileError, Stage, Step, health_command, read_dockerfile, words_of
from tools.environments import ROOT

SUITE: Final = "bookworm"
PACKAGES: Final = "python3,python3-venv,ca-certificates"
HEALTHY_S: Final = 900
"""The first start compiles, on a slow machine for a long time."""
_INHERITED: Final = re.compile(
    r"(PIP|UV|NPM_CONFIG)_.*|SSL_CERT_FILE|NODE_EXTRA_CA_CERTS|(HTTPS?|NO|ALL)_PROXY",
    re.IGNORECASE,
)
_OF_MACHINE: Final = ("/etc/resolv.conf", "/etc/ssl/certs", "/etc/pip.conf")
"""Files of this machine that steps see, so that they can reach what they install."""
_PATH: Final = "/usr/local/bin:/usr/local/sbin:/usr/bin:/usr/sbin:/bin:/sbin"
_RUN: Final = """
"$@" &
server=$!
tries=0
while ! {health} >/dev/null 2>&1; do
  tries=$((tries + 1))
  kill -0 $server 2>/dev/null || {{ echo "it has ended and was never healthy"; exit 1; }}
  [ $tries -lt {tries} ] || {{ echo "it is not healthy"; exit 1; }}
  sleep 1
done
echo "healthy after $tries tries, as $(id -u)"
if touch /opt/written 2>/dev/null; then echo "its root folder can be written"; exit 1; fi
kill -{signal} $server
wait $server
"""


def main() -> int:
    options = parser().parse_args()
    missing = [name for name in ("mmdebstrap", "bwrap") if shutil.which(name) is None]
    if missing or os.geteuid() != 0:
        why = f"{', '.join(missing)} missing: apt-get install mmdebstrap bubblewrap"
        print(f"tools.image: {why if missing else 'it has to run as root'}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="image-", dir=options.folder) as folder:
        try:
            build_and_run(Path(folder), options.bind)
        except (DockerfileError, subprocess.CalledProcessError) as error:
            print(f"tools.image: {error}", file=sys.stderr)
            return 1
    return 0


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.image", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--bind", nargs="*", default=[], help="folders that steps see, too")
    parser.add_argument("--folder", type=Path, help="where 2 GB are free [of temporary files]")
    return parser


def build_and_run(folder: Path, bind: Sequence[str]) -> None:
    """Build all stages in a folder, and run the last one."""
    stages = read_dockerfile(ROOT / "Dockerfile")
    base = folder / "base"
    told("making", f"Debian {SUITE}")
    subprocess.run(
        ["mmdebstrap", "--quiet", "--variant=minbase", f"--include={PACKAGES}", SUITE, str(base)],
        check=True,
    )
    (base / "usr/local/bin/python").symlink_to("/usr/bin/python3")
    built: dict[str, Path] = {}
    for number, stage in enumerate(stages):
        root = folder / (stage.name or f"stage-{number}")
        subprocess.run(["cp", "-a", str(base), str(root)], check=True)
        building = Building(root, built, bind)
        for step in stage.steps:
            told(f"{stage.name or number}:{step.line}", f"{step.word} {step.text}")
            building.take(step)
        built[stage.name] = root
    run(building, stages[-1])


class Building:
    """A stage while it is built: its root folder, and what later steps are run with."""

    def __init__(self, root: Path, built: Mapping[str, Path], bind: Sequence[str]) -> None:
        self.root = root
        self.environment = {"PATH": _PATH, "HOME": "/root"}
        self.folder = "/"
        self.user = "root"
        self.volumes: list[str] = []
        self._built = built
        self._bind = bind

    def take(self, step: Step) -> None:
        """Carry out a step."""
        match step.word:
            case "ENV":
                for each in shlex.split(step.text):
                    name, _, value = each.partition("=")
                    self.environment[name] = self._expanded(value)
            case "WORKDIR":
                self.folder = step.text
                self._within(step.text).mkdir(parents=True, exist_ok=True)
            case "USER":
                self.user = step.text
            case "VOLUME":
                self.volumes += step.text.split()
            case "COPY":
                self._copy(step.text.split())
            case "RUN":
                self._run(step.text)

    def _expanded(self, value: str) -> str:
        return re.sub(r"\$(\w+)", lambda name: self.environment.get(name[1], ""), value)

    def _within(self, path: str) -> Path:
        return self.root / (Path(self.folder) / path).relative_to("/")

    def _copy(self, words: Sequence[str]) -> None:
        origin, chosen = ROOT, list(words)
        if chosen[0].startswith("--from="):
            origin = self._built[chosen.pop(0).removeprefix("--from=")]
        *sources, target = chosen
        to = self._within(target)
        for source in sources:
            if origin == ROOT:
                copy_context(source, to)
                continue
            to.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run(["cp", "-a", str(origin / source.lstrip("/")), str(to)], check=True)

    def _run(self, text: str) -> None:
        own = {name: value for name, value in os.environ.items() if _INHERITED.fullmatch(name)}
        binds = [path for path in (*_OF_MACHINE, *self._bind) if Path(path).exists()]
        command = ["bwrap", "--bind", str(self.root), "/", "--dev", "/dev", "--proc", "/proc"]
        for path in binds:
            command += ["--ro-bind", os.path.realpath(path), path]
        command += ["--chdir", self.folder, "--clearenv"]
        for name, value in {**own, **self.environment}.items():
            command += ["--setenv", name, value]
        subprocess.run(
            [*command, *as_user(self.root, self.user), "/bin/sh", "-c", text], check=True
        )


def copy_context(source: str, to: Path) -> None:
    """Copy of the sources what is known to git and not kept out of an image by `.dockerignore`."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", source],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split("\0")
    wanted = [path for path in listed if path and in_image(path)]
    if not (ROOT / source).is_dir():
        to = to.parent
        wanted = [path for path in wanted if path == source]
    for path in wanted:
        copied = to / (path if (ROOT / source).is_dir() else Path(path).name)
        copied.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / path, copied, follow_symlinks=False)


def in_image(path: str) -> bool:
    """Whether `.dockerignore` lets a path into an image: it names what may come in."""
    lines = (ROOT / ".dockerignore").read_text().splitlines()
    return path.partition("/")[0] in {line[1:] for line in lines if line.startswith("!")}


def as_user(root: Path, user: str) -> list[str]:
    """The words before a command that run it as a user of a root folder."""
    if user == "root":
        return []
    (line,) = [
        each
        for each in (root / "etc/passwd").read_text().splitlines()
        if each.startswith(f"{user}:")
    ]
    uid, gid = line.split(":")[2:4]
    return ["setpriv", f"--reuid={uid}", f"--regid={gid}", "--clear-groups", "--no-new-privs"]


def run(building: Building, stage: Stage) -> None:
    """Run a stage as it is meant to be run, until it is healthy, and end it."""
    health = shlex.join(health_command(stage.settings["HEALTHCHECK"]))
    signal = stage.settings.get("STOPSIGNAL", "SIGTERM").removeprefix("SIG")
    script = _RUN.format(health=health, tries=HEALTHY_S, signal=signal)
    command = ["bwrap", "--ro-bind", str(building.root), "/", "--dev", "/dev", "--proc", "/proc"]
    command += [
        "--perms",
        "1777",
        "--tmpfs",
        "/tmp",
        "--unshare-net",
        "--unshare-pid",
        "--die-with-parent",
    ]
    for volume in building.volumes:
        command += ["--bind", str(building.root / volume.lstrip("/")), volume]
    command.append("--clearenv")
    for name, value in {**building.environment, "HOME": f"/home/{building.user}"}.items():
        command += ["--setenv", name, value]
    words = [*words_of(stage.settings["ENTRYPOINT"]), *words_of(stage.settings["CMD"])]
    told("running", shlex.join(words))
    user = as_user(building.root, building.user)
    subprocess.run([*command, *user, "/bin/sh", "-c", script, "sh", *words], check=True)
    told("ended", "in order")


def told(where: str, what: str) -> None:
    """Say what happens, on one line."""
    print(f"[{where}] {what[:110]}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
