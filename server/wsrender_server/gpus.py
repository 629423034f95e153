"""GPUs of this machine, without starting CUDA."""

import subprocess


def present_gpus() -> list[str]:
    """Numbers of the GPUs in the order of their bus, as the driver tells."""
    query = ["nvidia-smi", "--query-gpu=index", "--format=csv,noheader"]
    try:
        return subprocess.run(query, capture_output=True, text=True, check=True, timeout=30).stdout.split()
    except (OSError, subprocess.SubprocessError):
        return []
