"""The text of a stranger's robot model, looked at before anything else is done with it."""

from defusedxml import DefusedXmlException

from wsrender.errors import ModelError
from wsrender.robots import mjcf, xml_source
from wsrender_server.problems import problem_of_error, refusal

ROOTS = ("mujoco", "robot")


def check_model(field: str, text: str, prefix: str = "") -> str:
    """The name of the root element of XML that looks harmless; nothing is compiled.

    ``field`` within ``prefix`` is where in the body the text is.

    Raises ModelError for hostile text: document types, entities, outside references, too large, too deep; and for
    files that it includes. Raises HttpProblem 409 for text that is no model: not well-formed, or of another root
    element.
    """
    try:
        root = xml_source.parse(text, field)
    except ModelError as error:
        malformed = error.__cause__ is not None and not isinstance(error.__cause__, DefusedXmlException)
        if malformed or not text.strip():
            raise refusal(problem_of_error(error, prefix), 409) from None
        raise
    if root.tag not in ROOTS:
        wrong = ModelError(field, f"the root element is <{root.tag}>; <mujoco> or <robot> (URDF) is needed")
        raise refusal(problem_of_error(wrong, prefix), 409)
    if root.tag == "mujoco":
        mjcf.refuse_includes(root, field)
    return root.tag


def decoded_model(content: bytes) -> str:
    """The text of an uploaded model. Raises HttpProblem 409 for anything but UTF-8."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        wrong = ModelError("document", f"must be UTF-8 text; byte {error.start} is not")
        raise refusal(problem_of_error(wrong), 409) from None
