"""
How do I put the interactive view into a page?
==============================================

``report`` writes one HTML file with the viewer, pictures, tables and the job; it loads nothing from anywhere. Within a
page of your own an ``<iframe>`` shows it, as the views of this gallery are shown.
"""

import tempfile
from pathlib import Path

import wsrender as ws

result = ws.analyze("phantom_omni", ws.Sobol(1 << 17), ["manipulability"], refined_volume=None, device="cpu")
page = Path(tempfile.mkdtemp()) / "report.html"
result.report(page, views=[])
print(f"{page.name}: {page.stat().st_size / 1e6:.1f} MB")

# Picture: Interactive view of a haptic device in its workspace.
result
