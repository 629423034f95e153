"""Names of file formats as query parameters: those of the table, whoever added them."""

from collections.abc import Callable
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from wsrender.results.export.formats import one_of


class OneOf:
    """Marks text that must be one of some suffixes, which are asked for anew: formats may be added later."""

    def __init__(self, suffixes: Callable[[], list[str]]):
        self._suffixes = suffixes

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "enum": sorted(self._suffixes())}

    def _checked(self, suffix: str) -> str:
        if suffix not in self._suffixes():
            choices = one_of(f"'{each}'" for each in sorted(self._suffixes()))
            raise PydanticCustomError("format", "Input should be {choices}", {"choices": choices})
        return suffix
