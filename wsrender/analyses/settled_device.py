"""The device of a job, settled once for every process that takes part in it."""

from collections.abc import Mapping
from typing import Any

from wsrender.engine import devices_of, target_of
from wsrender.errors import InputError


def settled_device(request: str, resolved: Mapping[str, Any] | None) -> tuple[str, str]:
    """Device and target of a request; "auto" becomes "cuda" or "cpu", or what an earlier plan settled.

    Raises InputError where the device is not here, or is of another target than the earlier plan's.
    """
    if resolved is None:
        devices = devices_of(request)
        device = request if request != "auto" else ("cuda" if devices[0].is_cuda else "cpu")
        return device, target_of(devices)
    target = target_of(devices_of(resolved["device"]))
    if target != resolved["target"]:
        raise InputError("device", f"the job was planned for {resolved['target']}, this machine has {target}")
    return resolved["device"], target
