"""Whether answers are of the form that an OpenAPI document says of them."""

from jsonschema import Draft202012Validator


def validator_of(document, path, method, status, media_type="application/json"):
    """What checks an answer of an operation."""
    schema = document["paths"][path][method]["responses"][str(status)]["content"][media_type]["schema"]
    return Draft202012Validator({**schema, "components": document["components"]})


def broken(answer):
    """The answer with each of its fields renamed, and with each of another type."""
    for name in answer:
        yield {f"{key}_" if key == name else key: value for key, value in answer.items()}
        yield answer | {name: {"odd": [{}]}}
