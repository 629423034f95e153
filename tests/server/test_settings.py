"""Settings are described where an administrator looks for them."""

import re
from pathlib import Path

from wsrender_server.settings import PREFIX, Settings

README = Path(__file__).parent.parent.parent / "server" / "README.md"


def test_the_readme_names_every_setting():
    """By its variable, or after another one by the end of it: `…_CERT_FILE`."""
    said = set(re.findall(r"`([A-Z_…]+)`", README.read_text()))
    ends = tuple(name.removeprefix("…") for name in said if name.startswith("…"))
    names = {PREFIX + name.upper() for name in Settings.model_fields}
    assert {name for name in names if name not in said and not name.endswith(ends)} == set()
