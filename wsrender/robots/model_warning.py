"""The category of the warnings that loading a robot gives."""


class ModelWarning(UserWarning):
    """A robot model was loaded, but not all of it could be used as it stands."""
