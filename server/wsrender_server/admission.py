"""What a submitted job or robot model must fulfil; nothing here runs native code on strangers' models."""

import asyncio
import gc
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import repeat
from pathlib import Path
from typing import Any, TypeVar
from xml.etree.ElementTree import Element

from defusedxml import DefusedXmlException
from pydantic import TypeAdapter
from starlette.concurrency import run_in_threadpool

from wsrender.analyses.jobs import job_schema, parse_job
from wsrender.documents.arm import Arm, ArmPath, dotted, local_paths, models_in
from wsrender.documents.constraints import Constraints
from wsrender.documents.document import Document
from wsrender.documents.problems import MOST_PROBLEMS
from wsrender.documents.reading import read_document
from wsrender.documents.sampling import Converge, Grid
from wsrender.errors import DocumentError, InputError, ModelError, ResourceError, WsrenderError
from wsrender.indices.index_catalogue import find, option_values, resolve
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.results.view import Edited
from wsrender.robots import archives, library, loading, mjcf, xml_source
from wsrender_server.job_body import LONGEST_HERE, SubmissionOptions, check_size, read_body, refused
from wsrender_server.jobs.child_process import give_back_memory
from wsrender_server.jobs.documents import CanonicalDocument, uploads_in
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.files import write_durably
from wsrender_server.jobs.records import Submission
from wsrender_server.jobs.store import ATTEMPTS, BUSY, Again, JobStore, SubmissionRequest
from wsrender_server.problems import HttpProblem, pointer, problem_of_error, refusal
from wsrender_server.side_process import SideProcess
from wsrender_server.together import Together

Found = TypeVar("Found")

ROOTS = ("mujoco", "robot", "sdf")
LOCAL_ONLY = "is for local runs only; upload the file and name it by model, or send text or points"
BEYOND_LIMITS = 10**18  # samples
LONGEST_S = 60.0  # that a long body may take
LONGEST_TOGETHER = 1 << 14  # bytes of a body that others wait for
EDITED: TypeAdapter[Edited] = TypeAdapter(Edited)


def check_model(field: str, text: str, prefix: str = "") -> Element:
    """The root element of XML that looks harmless; nothing is compiled.

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
        wrong = ModelError(field, f"the root element is <{root.tag}>; {loading.ROOTS}")
        raise refusal(problem_of_error(wrong, prefix), 409)
    if root.tag == "mujoco":
        mjcf.refuse_includes(root, field)
    return root


def check_archive(field: str, content: bytes) -> None:
    """Check a ZIP of a model by its directory alone; nothing is unpacked, and its files are read by the jobs.

    Raises HttpProblem 409 for what is no ZIP of a model, or no harmless one.
    """
    try:
        archives.check(content, field)
    except ModelError as error:
        raise refusal(problem_of_error(error), 409) from None


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
class Admitted:
    """A submission that is right as far as can be told without its models."""

    document: CanonicalDocument
    options: SubmissionOptions
    prefix: str = ""
    """Where in the body the document is, as a JSON pointer; empty: it is the body."""
    written: Path | None = None
    """File of a long document's text."""

    def discard(self) -> None:
        """Remove the file, where nobody has taken it."""
        if self.written is not None:
            self.written.unlink(missing_ok=True)


def admit(text: bytes, max_samples: int) -> Admitted:
    """The submission of a body.

    Raises DocumentError, ModelError, InputError for a wrong document; HttpProblem 400 for text that is no JSON, 409 for
    a document that keeps to its schema but contradicts itself, and for a model that is no XML; ResourceError for more
    samples than allowed.
    """
    check_size(text)
    body = read_body(text)
    try:
        document = canonical(body.document, max_samples, body.prefix)
    except DocumentError as error:
        raise refused(error, text, "JobSubmission", body.prefix) from None
    return Admitted(document, body.options, body.prefix)


def canonical(document: Mapping[str, Any], max_samples: int, prefix: str = "") -> CanonicalDocument:
    """The canonical document, all defaults present; raises as `admit`. ``prefix``: where in the body it is."""
    job = parse_job(document)
    plain = job.model_dump(mode="json")
    refuse_paths(plain)
    models = check_models(plain, prefix)
    arms = job.arms()
    for path, part in ({(): job} | arms).items():
        _check_indices(part, path)
        _check_constraints(part, path)
        _check_samples(part, path, job, max_samples)
    total = sum(least_samples(each.sampling, each) for each in job.sweeps())
    if total > max_samples:
        message = f"have at least {total:.4g} samples together; this server allows {max_samples:.4g}"
        raise ResourceError("sampling", message)
    return CanonicalDocument.of(plain, models)


def check_models(document: Any, prefix: str = "") -> list[tuple[ArmPath, dict[str, Any]]]:
    """The models that a canonical document names, each with its path.

    Raises DocumentError, ModelError or HttpProblem for models that cannot be had, or are not harmless text.
    """
    models = [*models_in(document)]
    for path, model in models:
        if model.get("library") is not None:
            try:
                library.find(model["library"])
            except ModelError as error:
                raise DocumentError([(dotted(path, "library"), error.message)]) from None
        for name in ("mjcf", "urdf"):
            if model.get(name) is not None:
                check_model(dotted(path, name), model[name], prefix)
    return models


def check_uploads(store: JobStore, owner: str, uploads: Iterable[tuple[str, str]], prefix: str = "") -> None:
    """Raises HttpProblem 404 for what the owner did not upload: (dotted path, SHA-256) of each."""
    for path, sha256 in uploads:
        if store.model_path(owner, sha256) is None:
            raise HttpProblem(
                404,
                f"you have uploaded no model {sha256}",
                "model_not_found",
                errors=[(pointer(path, prefix), "is no model that you uploaded")],
            )


def uploads_of_edited(text: bytes) -> list[tuple[str, str]]:
    """What the body of an edited robot or environment names of uploads: (dotted path, SHA-256); raises as `admit`."""
    check_size(text)
    try:
        document = read_document(text, EDITED).model_dump(mode="json")
        refuse_paths(document)
        check_models(document)
    except DocumentError as error:
        raise refused(error, text, "Edited", "") from None
    return [*uploads_in(document)]


@dataclass(frozen=True)
class _Body:
    """The body of a submission, and what makes a request to the store of it."""

    owner: str
    text: bytes
    request_of: Callable[[Admitted], SubmissionRequest]


class Admissions:
    """Reads bodies: short bodies in a thread, long ones in a child process, one after another.

    A body of 15 MB may become a gigabyte of lists, and holds Python's lock for seconds. Of many short submissions at
    once all share a turn of a thread, and a transaction: turns are what they would wait for.
    """

    def __init__(self, store: JobStore, process: SideProcess, max_samples: int):
        self._store = store
        self._process = process
        self._max_samples = max_samples
        self._warming: asyncio.Task[Any] | None = None
        self._together = Together(self._submit_all)

    async def submit(self, owner: str, text: bytes, request_of: Callable[[Admitted], SubmissionRequest]) -> Submission:
        """The submission of a body, as ``request_of`` asks for it.

        Raises as `admit`, `check_uploads` and `JobStore.submit`.
        """
        if len(text) > LONGEST_TOGETHER:
            return await self.of(owner, text, lambda found: self._store.submit_alone(request_of(found), found.written))
        asked: _Body | SubmissionRequest = _Body(owner, text, request_of)
        for _ in range(ATTEMPTS):
            answer = await self._together.answer(asked)
            if isinstance(answer, Submission):
                return answer
            if not isinstance(answer, Again):  # too long for a row
                return await run_in_threadpool(self._store.submit_alone, answer)
            asked = await run_in_threadpool(self._store.prepare_again, answer)
        raise StoreUnavailable(BUSY)

    def _submit_all(
        self, asked: Sequence[_Body | SubmissionRequest]
    ) -> "list[Submission | Again | SubmissionRequest | Exception]":
        """What comes of each, or what it raises; a request where it is to go alone."""
        answers: list[Any] = [self._request(each) for each in asked]
        ready = [k for k, each in enumerate(answers) if isinstance(each, SubmissionRequest) and each.document.is_short]
        if ready:
            for k, answer in zip(ready, self._store.submit_all([answers[k] for k in ready]), strict=True):
                answers[k] = answer
        return answers

    def _request(self, asked: _Body | SubmissionRequest) -> SubmissionRequest | Exception:
        if isinstance(asked, SubmissionRequest):
            return asked
        try:
            return self._checked(asked.owner, admit(asked.text, self._max_samples), asked.request_of)
        except Exception as error:  # its own; the others go on
            return error

    async def of(self, owner: str, text: bytes, then: Callable[[Admitted], Found]) -> Found:
        """What ``then`` makes of the submission of a body, in a thread; raises as `admit` and `check_uploads`."""
        if len(text) <= LONGEST_HERE:
            return await run_in_threadpool(lambda: self._checked(owner, admit(text, self._max_samples), then))
        scratch = self._store.files.root / "scratch"
        found = await self._process.run(_admit_aside, text, self._max_samples, scratch, timeout_s=LONGEST_S)
        if isinstance(found, dict):
            raise refusal(found, found["status"])
        try:
            return await run_in_threadpool(self._checked, owner, found, then)
        finally:
            found.discard()

    def _checked(self, owner: str, found: Admitted, then: Callable[[Admitted], Found]) -> Found:
        check_uploads(self._store, owner, found.document.uploads, found.prefix)
        return then(found)

    async def check_edited(self, owner: str, text: bytes) -> None:
        """Check the body of a robot or an environment that is edited; raises as `uploads_of_edited`."""
        await run_in_threadpool(check_uploads, self._store, owner, await self.read(uploads_of_edited, text))

    async def read(self, function: Callable[[bytes], Found], text: bytes) -> Found:
        """What a module-level function, which returns no dict, reads in a body: in the child where that is long.

        Raises HttpProblem for whatever the function refuses there.
        """
        if len(text) <= LONGEST_HERE:
            return await run_in_threadpool(function, text)
        found = await self._process.run(_read_aside, function, text, timeout_s=LONGEST_S)
        if isinstance(found, dict):
            raise refusal(found, found["status"])
        return found

    def warm_up(self) -> None:
        """Start the child, so that the first long body need not wait for it; called on the event loop."""
        self._warming = asyncio.create_task(self._process.run(job_schema))
        self._warming.add_done_callback(lambda task: task.cancelled() or task.exception())  # the body will tell

    def close(self) -> None:
        """End the child."""
        self._process.close()


def _admit_aside(text: bytes, max_samples: int, scratch: Path) -> Admitted | dict[str, Any]:
    """The submission of a long body, its document written to a file, or the problem document of what is wrong."""

    def admitted() -> Admitted:
        found = admit(text, max_samples)
        if found.document.is_short:
            return found
        path = scratch / f"{uuid.uuid4().hex}.json"
        write_durably(path, (found.document.text or "").encode())
        return replace(found, document=replace(found.document, text=None), written=path)

    return _aside(admitted)


def _read_aside(function: Callable[[bytes], Found], text: bytes) -> Found | dict[str, Any]:
    """What a function reads in a long body, or the problem document of what is wrong."""
    return _aside(partial(function, text))


def _aside(read: Callable[[], Found]) -> Found | dict[str, Any]:
    """What reading a long body gives, or the problem document of what is wrong; its memory is given back."""
    gc.disable()  # millions of lists hold no cycles, and looking for some takes as long as all the rest
    try:
        return read()
    except (HttpProblem, WsrenderError) as error:
        return problem_of_error(error)
    finally:
        gc.enable()
        give_back_memory()


def _check_samples(part: Document, path: ArmPath, job: Document, max_samples: int) -> None:
    sampling = getattr(part, "sampling", None)
    if sampling is None:
        return
    samples = least_samples(sampling, part)
    limits = {"this server allows": max_samples}
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
        return _library_joints()[library.canonical(part.robot.library)]
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
