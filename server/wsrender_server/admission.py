"""What a submitted job or robot model must fulfil; nothing here runs native code on strangers' models."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import repeat
from typing import Any

from defusedxml import DefusedXmlException

from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.documents.arm import Arm, ArmPath, dotted, local_paths, models_in
from wsrender.documents.constraints import Constraints
from wsrender.documents.document import Document
from wsrender.documents.problems import MOST_PROBLEMS
from wsrender.documents.sampling import Converge, Grid
from wsrender.errors import DocumentError, InputError, ModelError, ResourceError
from wsrender.indices.index_catalogue import find, option_values, resolve
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.robots import library, mjcf, xml_source
from wsrender_server.jobs.store import JobStore
from wsrender_server.problems import HttpProblem, pointer, problem_of_error, refusal

ROOTS = ("mujoco", "robot")
LOCAL_ONLY = "is for local runs only; upload the file and name it by model, or send text or points"
BEYOND_LIMITS = 10**18  # samples


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


def refuse_paths(document: Any) -> None:
    """Raises DocumentError where a canonical document names a file: a server opens none."""
    for path in local_paths(document):
        raise DocumentError([(dotted(path), LOCAL_ONLY)])


@dataclass(frozen=True)
class Admission:
    """Admits the documents of one owner, whatever their analysis."""

    store: JobStore
    owner: str
    max_samples: int
    prefix: str
    """Where in the body the document is, as a JSON pointer; empty: it is the body."""

    def canonical(self, document: Mapping[str, Any]) -> dict[str, Any]:
        """The canonical document, all defaults present.

        Raises DocumentError, ModelError, InputError for a wrong document; HttpProblem 404 for a model that the owner
        did not upload, 409 for text that is no XML; ResourceError for more samples than allowed.
        """
        job = parse_job(document)
        plain = job.model_dump(mode="json")
        refuse_paths(plain)
        self.check_models(plain)
        arms = job.arms()
        for path, part in ({(): job} | arms).items():
            _check_indices(part, path)
            _check_constraints(part, path)
            self._check_samples(part, path, job)
        total = sum(least_samples(each.sampling, each) for each in job.sweeps())
        if total > self.max_samples:
            message = f"have at least {total:.4g} samples together; this server allows {self.max_samples:.4g}"
            raise ResourceError("sampling", message)
        return json.loads(canonical_json(job))

    def check_models(self, document: Any) -> None:
        """Raises DocumentError, ModelError or HttpProblem for models that the owner cannot have."""
        for path, model in models_in(document):
            self._check_model(model, path)

    def _check_model(self, model: Mapping[str, Any], path: ArmPath) -> None:
        if model.get("library") is not None:
            try:
                library.find(model["library"])
            except ModelError as error:
                raise DocumentError([(dotted(path, "library"), error.message)]) from None
        for name in ("mjcf", "urdf"):
            if model.get(name) is not None:
                check_model(dotted(path, name), model[name], self.prefix)
        if (sha256 := model.get("model")) is not None and self.store.get_model(self.owner, sha256) is None:
            raise HttpProblem(
                404,
                f"you have uploaded no model {sha256}",
                "model_not_found",
                errors=[(pointer(dotted(path, "model"), self.prefix), "is no model that you uploaded")],
            )

    def _check_samples(self, part: Document, path: ArmPath, job: Document) -> None:
        sampling = getattr(part, "sampling", None)
        if sampling is None:
            return
        samples = least_samples(sampling, part)
        limits = {"this server allows": self.max_samples}
        if not isinstance(sampling, Converge):  # which stops by itself where a grid would be too large
            limits["max_samples is"] = getattr(part, "max_samples", getattr(job, "max_samples", BEYOND_LIMITS))
        for who, limit in limits.items():
            if samples > limit:
                message = f"has at least {samples:.4g} samples; {who} {limit:.4g}"
                raise ResourceError(dotted(path, "sampling"), message)


def least_samples(sampling: Any, part: Document) -> int:
    """Samples that a part of a document takes at least; exact where its joints are known without compiling a model."""
    if not isinstance(sampling, Grid | Converge):
        return sampling.count
    levels = sampling.per_joint if isinstance(sampling, Grid) else sampling.start
    joints = _joints(part) if isinstance(levels, int) else len(levels)
    free = max(joints - len(sampling.locked), 1)
    # A list may say how many a locked joint would have, too.
    return _product(repeat(levels, free) if isinstance(levels, int) else sorted(levels)[:free])


def _product(factors: Iterable[int]) -> int:
    """The product, or a part of it where that is beyond all limits."""
    product = 1
    for factor in factors:
        product *= factor
        if product > BEYOND_LIMITS:
            break
    return product


def _joints(part: Document) -> int:
    """Joints of an arm at least: all of its robot's where it does not name the ends of its chain."""
    if not isinstance(part, Arm) or part.base is not None or part.tip is not None:
        return 1
    if part.robot.dh is not None:
        return len(part.robot.dh.rows)
    if part.robot.library is not None:
        return _library_joints()[part.robot.library]
    return 1


@cache
def _library_joints() -> dict[str, int]:
    return {robot.name: robot.joints for robot in library.describe()}


def _check_indices(part: Document, path: ArmPath) -> None:
    """Check the local indices that a part of a document names, those it converges by among them."""
    indices, sampling = getattr(part, "indices", ()), getattr(part, "sampling", None)
    names = [] if isinstance(indices, str) else [("indices", name) for name in indices]
    if isinstance(sampling, Converge):
        names.append(("sampling.index", sampling.index))
    problems = []
    for field, name in names:
        try:
            find(name)
        except InputError as error:
            problems.append((dotted(path, field), error.message))
        if len(problems) == MOST_PROBLEMS:
            break
    if problems:
        raise DocumentError(problems)
    if given := getattr(part, "index_options", None):
        try:
            option_values(given, resolve(indices, has_inertia=True))
        except InputError as error:
            raise DocumentError([(dotted(path, error.field), error.message)]) from None


def _check_constraints(part: Document, path: ArmPath) -> None:
    """Check the names and options of the constraints of a part of a document."""
    choice = getattr(part, "constraints", None)
    if not isinstance(choice, Constraints):  # those of designs are others
        return
    try:
        asked = constraints_of(choice)
    except InputError as error:
        raise DocumentError([(dotted(path, error.field), error.message)]) from None
    for each in on_host(asked):
        message = "is a Python function of a process, which jobs of a server cannot ask: give one that can be traced"
        raise DocumentError([(dotted(path, f"constraints.{each.name}"), message)])
