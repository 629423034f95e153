"""What axe-core finds on a page."""

from pathlib import Path

import pytest

_SCRIPT = Path(__file__).parents[2] / "server/web/node_modules/axe-core/axe.min.js"


def serious_faults(page):
    """The serious and critical faults of a page of Playwright: the rule, and the first elements that break it."""
    if not _SCRIPT.exists():
        pytest.skip("needs axe-core: npm ci in server/web")
    page.evaluate(_SCRIPT.read_text(encoding="utf-8") + ";0")
    found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")["violations"]
    serious = [each for each in found if each["impact"] in ("serious", "critical")]
    return [(each["id"], [node["html"][:160] for node in each["nodes"][:4]]) for each in serious]
