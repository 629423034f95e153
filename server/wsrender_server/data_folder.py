"""Where a server keeps its data by default."""

import warnings
from pathlib import Path

OLD_FOLDER = Path("wsrender-data")  # in the working directory: the default of 0.1


def default_data_dir() -> Path:
    """The user's own folder for wsrender; ``./wsrender-data`` where there is one, with a warning. Creates nothing."""
    import platformdirs

    users = platformdirs.user_data_path("wsrender", appauthor=False)
    if not OLD_FOLDER.is_dir():
        return users
    text = (
        f"data_dir: {OLD_FOLDER.absolute()} is used, the default folder of earlier versions; the default is now "
        f"{users}: move the folder there, or name it by --data-dir or WSRENDER_DATA_DIR"
    )
    warnings.warn(text, UserWarning, stacklevel=2)
    return OLD_FOLDER.absolute()
