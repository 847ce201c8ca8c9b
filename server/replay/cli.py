"""`esplanade replay`: a recording is run again, verified, and written as trajectories."""

from argparse import Namespace

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.commandline.output import console
from esplanade.recordings.writing import WritingError
from esplanade.server import logs
from esplanade.server.offline.settings import OfflineSettings
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.replay.options import asks_what_if


def run(options: Namespace) -> int:
    """Run a recording again as the options say; returns the exit code."""
    try:
        # What reads recordings is in an extra.
        from esplanade.server.recording.reader import Recording  # noqa: PLC0415
        from esplanade.server.replay import running  # noqa: PLC0415
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        raise CommandError(f"recordings need {package}: install esplanade[record]") from None
    with logs.written(OfflineSettings(log_level="warning")):
        try:
            with Recording(options.file) as recording:
                if options.info:
                    console().print(running.info(recording))
                    return exit_codes.OK
                running.check_program(recording, options)
                if asks_what_if(options):
                    from esplanade.server.whatif.command import what_if  # noqa: PLC0415

                    return what_if(recording, options)
                return running.replay(recording, options)
        except ZoneRecordingError as error:
            raise CommandError(str(error)) from None
        except WritingError as error:
            raise CommandError(f"--trajectories: {error}") from None
