"""Names of the OpenAPI document, as clients that generators made have them.

``python -m tests.server.http.openapi_names`` writes those that a test compares.
"""

import json
import tempfile
from pathlib import Path

from wsrender_server.app import create_app
from wsrender_server.settings import Settings

FILE = Path(__file__).parent / "openapi_names.txt"


def names_of(document):
    """A line for each operation with its parameters, bodies and answers, and for each schema with its properties."""
    for path, methods in sorted(document["paths"].items()):
        for method, operation in sorted(methods.items()):
            parameters = sorted(f"{each['in']}:{each['name']}" for each in operation.get("parameters", ()))
            body = sorted(operation.get("requestBody", {}).get("content", ()))
            answers = [
                f"{status}:{','.join(sorted(each.get('content', ())))}"
                for status, each in sorted(operation["responses"].items())
            ]
            taken = " ".join((*parameters, *body))
            yield f"{operation['operationId']} {method.upper()} {path} {taken} -> {' '.join(answers)}"
    for name, schema in sorted(document["components"]["schemas"].items()):
        parts = schema.get("properties") or [_name(each) for each in schema.get("anyOf", schema.get("oneOf", ()))]
        required = schema.get("required", ())
        marked = sorted(part + "!" * (part in required) for part in parts)
        yield f"{name}: {' '.join(marked) or json.dumps(schema.get('enum'))}"


def _name(schema):
    return schema.get("$ref", schema.get("type", "")).rpartition("/")[2]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        FILE.write_text("\n".join(names_of(create_app(Settings(data_dir=folder)).openapi())) + "\n")
