"""Numbers may change from one version of wsrender to the next: whose numbers a result holds, and what to say of it."""

from wsrender import __version__
from wsrender.notices import Notice


def notices_of(version: str) -> list[Notice]:
    """What an owner should know of a result that a version has computed: nothing where it is this one."""
    if version == __version__:
        return []
    return [
        Notice(
            "other_version",
            f"computed by wsrender {version}; this server runs {__version__}, whose numbers may differ",
            "submit the job again for numbers of this version",
        )
    ]
