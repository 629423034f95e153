"""The examples of an OpenAPI document, by where they stand."""


def bodies(document):
    """(method, path, operation, media type, what is said of it) of every body of a request."""
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            for media_type, content in operation.get("requestBody", {}).get("content", {}).items():
                yield method, path, operation, media_type, content


def examples_of(content):
    """The examples of a body by name."""
    single = {"example": content["example"]} if "example" in content else {}
    return single | {name: each["value"] for name, each in content.get("examples", {}).items()}


def schema_examples(document):
    """(schema, name of a field or None, example, the schema it is an example of) of the named schemas."""
    for name, schema in document["components"]["schemas"].items():
        for field, part in [(None, schema), *schema.get("properties", {}).items()]:
            for example in part.get("examples", ()):
                yield name, field, example, part
