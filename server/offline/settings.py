"""The settings of a world without a server: those given, and no variable of the environment."""

from pydantic_settings import BaseSettings, PydanticBaseSettingsSource

from esplanade.server.settings import ServerSettings


class OfflineSettings(ServerSettings):
    """Settings of a world that nobody connects to: what was given is all that makes it."""

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],  # noqa: ARG003 - the library hands over all of them
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,  # noqa: ARG003
        dotenv_settings: PydanticBaseSettingsSource,  # noqa: ARG003
        file_secret_settings: PydanticBaseSettingsSource,  # noqa: ARG003
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Only what is given to the constructor."""
        return (init_settings,)
