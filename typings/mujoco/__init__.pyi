# MuJoCo is a compiled module without type stubs.
from typing import Any

def __getattr__(name: str) -> Any: ...
