"""The job ``design_optimization``: parameters of another job, and the values of its result that they shall improve."""

import re
from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    PrivateAttr,
    SerializeAsAny,
    SerializerFunctionWrapHandler,
    StrictBool,
    ValidationError,
    WithJsonSchema,
    field_serializer,
    model_validator,
)
from pydantic.functional_validators import ModelWrapValidatorHandler

from wsrender.analyses.jobs import parse_job
from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.document import Document
from wsrender.documents.format import JobDocument, example
from wsrender.documents.json_pointer import in_words_of, numbers_at, steps_of
from wsrender.documents.problems import located, path_text, tagged
from wsrender.documents.quantities import FileName, Name, Number, PositiveNumber, Seed, integer, quoted, real, sequence
from wsrender.errors import DocumentError

MOST_PARAMETERS, MOST_OBJECTIVES = 50, 6
MOST_EVALUATIONS = 1_000_000
SPHERE, CUBE = "inscribed_sphere", "inscribed_cube"
EXACT = EXACT_VOLUME, EXACT_SPHERE, EXACT_CUBE = "exact_volume", "exact_inscribed_sphere", "exact_inscribed_cube"
NAMED_VALUES = {EXACT_VOLUME: "m^3"} | dict.fromkeys((EXACT_SPHERE, EXACT_CUBE, SPHERE, CUBE), "m")
_UNITS = {"_m3": "m^3", "_m2": "m^2", "_m": "m"}


def _design(value: Any) -> Any:
    """The parsed job that is optimised."""
    if isinstance(value, Document):
        return value
    if isinstance(value, Mapping) and value.get("analysis") == "design_optimization":
        raise ValueError("must be another analysis than design_optimization")
    try:
        return parse_job(value, without=("design_optimization",))
    except DocumentError as error:
        problems = [located(tuple(field.split(".")), message) for field, message in error.problems]
        raise ValidationError.from_exception_data("design", problems) from None


def _linear(value: Any) -> Any:
    if isinstance(value, Mapping):
        raise ValueError('must be a list of bounds of the parameters; those of configurations stand in "design"')
    return value


def _pointers(value: Any) -> tuple[str, ...]:
    pointers = (value,) if isinstance(value, str) else tuple(sequence(value))
    if not pointers or not all(isinstance(pointer, str) for pointer in pointers):
        raise ValueError("must be a JSON pointer, or a list of them")
    for pointer in pointers:
        steps_of(pointer)
    return pointers


def _bounds(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value))
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise ValueError("must be [low, high], low below high")
    return numbers


def _value(value: Any) -> Any:
    if isinstance(value, str) and value not in NAMED_VALUES and not value.startswith("/"):
        raise ValueError(f"must be {quoted(NAMED_VALUES)} or a JSON pointer into the result document")
    return value


def _steps(value: Any) -> int | tuple[int, ...]:
    steps = tuple(integer(number) for number in (sequence(value) if hasattr(value, "__len__") else [value]))
    if not steps or not 1 <= min(steps) <= max(steps) <= MOST_EVALUATIONS:
        raise ValueError("must be a whole number of at least 1, or a list of one for each parameter")
    return steps if hasattr(value, "__len__") else steps[0]


def _evaluations(value: Any) -> Any:
    if isinstance(value, EvaluationsInFile):
        return value
    if isinstance(value, Mapping):
        return EvaluationsInFile.model_validate(value)
    return tuple(tuple(None if x is None else real(x) for x in sequence(row)) for row in sequence(value))


def _coefficients(value: Any) -> dict[str, float]:
    if not isinstance(value, Mapping) or not value:
        raise ValueError("must be an object of numbers by names of parameters")
    return {str(name): real(number) for name, number in value.items()}


Pointers = Annotated[tuple[str, ...], BeforeValidator(_pointers, json_schema_input_type=tuple[str, ...] | str)]
Bounds = Annotated[tuple[float, float], BeforeValidator(_bounds)]


class DesignParameter(Document):
    """A number that may vary, at one or several places of the job."""

    name: FileName
    """What tables and constraints call it."""
    pointers: Pointers
    """Where it stands in the design as it is written, or in its canonical form, as JSON pointers: "/robot/dh/rows/1/a",
    "/robot/dh/rows/0/limits_deg/1", "/mechanism/link_m"; all get the value."""
    bounds: Bounds
    """[low, high], in the unit of the field."""


class LinearConstraint(Document):
    """Bounds of a weighted sum of parameters."""

    coefficients: Annotated[dict[str, float], BeforeValidator(_coefficients)]
    """Weight of each parameter by its name; those not named have none."""
    lower: Number | None = None
    """Least value of the sum; null: none."""
    upper: Number | None = None
    """Largest value of the sum; null: none."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.lower is None and self.upper is None:
            yield "lower", 'must be given, or "upper", or both'
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            yield "upper", f"must be at least lower, {self.lower:g}"


class Objective(Document):
    """A value of the result that shall be large or small."""

    value: Annotated[Name, BeforeValidator(_value)]
    """"exact_volume" [m³], "exact_inscribed_sphere", "exact_inscribed_cube" of a mechanism bounded by spheres: radius
    and edge of the largest, the cube's faces along the world's axes [m]; "inscribed_sphere", "inscribed_cube": of the
    largest in the occupied voxels [m]; or a JSON pointer to a number of the result document, such as
    "/volume_m3/occupied", "/volume_m3/shared" or "/indices/manipulability/workspace_mean"."""
    goal: Literal["maximize", "minimize"] = "maximize"
    """What is better."""
    weight: PositiveNumber = 1.0
    """Its share in the sum of several, in 1 / its unit."""

    @property
    def name(self) -> str:
        """Name of its column."""
        if self.value in NAMED_VALUES:
            return self.value
        return "_".join(re.sub("_m[23]?$", "", step) for step in steps_of(self.value))

    @property
    def unit(self) -> str | None:
        """Unit of the value, None where its name does not say it."""
        if self.value in NAMED_VALUES:
            return NAMED_VALUES[self.value]
        return next((unit for end, unit in _UNITS.items() if any(s.endswith(end) for s in steps_of(self.value))), None)


class DifferentialEvolution(Document):
    """Search of the best sum of the objectives (Storn and Price 1997), then along gradients of an exact volume."""

    method: Literal["differential_evolution"] = "differential_evolution"
    """Name of the search."""
    population: Annotated[int, Field(ge=5, le=1000), BeforeValidator(integer)] = 15
    """Designs of a generation for each parameter."""
    generations: Annotated[int, Field(ge=1, le=10_000), BeforeValidator(integer)] = 100
    """Most generations."""
    tolerance: PositiveNumber = 1e-4
    """Spread of a generation, relative to its mean, at which the search ends [1]."""
    refine: StrictBool = True
    """Whether an exact volume is improved further by its gradient."""
    seed: Seed = 0
    """Seed of the search; the same seed gives the same designs."""

    def evaluations(self, parameters: int) -> int:
        """Most designs that it evaluates."""
        return self.population * parameters * (self.generations + 1)


class GridSweep(Document):
    """Every combination of equal steps."""

    method: Literal["sweep"] = "sweep"
    """Name of the search."""
    steps: Annotated[int | tuple[int, ...], BeforeValidator(_steps)] = 21
    """Values of each parameter, both bounds among them (1: the middle): one number, or one for each parameter."""

    def counts(self, parameters: int) -> tuple[int, ...]:
        """Values of each parameter."""
        return (self.steps,) * parameters if isinstance(self.steps, int) else self.steps

    def evaluations(self, parameters: int) -> int:
        """Designs that it evaluates."""
        total = 1
        for count in self.counts(parameters):
            total *= count
        return total


class ParetoSearch(Document):
    """Designs that no other beats in every objective, by NSGA-II (Deb et al. 2002); needs the extra "design"."""

    method: Literal["pareto"] = "pareto"
    """Name of the search."""
    population: Annotated[int, Field(ge=4, le=10_000), BeforeValidator(integer)] = 40
    """Designs of a generation."""
    generations: Annotated[int, Field(ge=1, le=10_000), BeforeValidator(integer)] = 50
    """Generations."""
    seed: Seed = 0
    """Seed of the search; the same seed gives the same designs."""

    def evaluations(self, parameters: int) -> int:
        """Designs that it evaluates."""
        return self.population * self.generations


class EvaluationsInFile(Document):
    """A CSV file of designs and their values, kept up to date while a search runs."""

    path: Name
    """The file; local runs only."""


_AnySearch = DifferentialEvolution | GridSweep | ParetoSearch
SEARCHES = ("differential_evolution", "sweep", "pareto")
Search = Annotated[_AnySearch, Discriminator("method"), BeforeValidator(tagged("method", SEARCHES))]
AnalysedDocument = Annotated[
    SerializeAsAny[Document],
    BeforeValidator(_design),
    WithJsonSchema({"type": "object", "properties": {"analysis": {"type": "string"}}, "required": ["analysis"]}),
]


class DesignOptimizationJob(JobDocument):
    """Find parameters of a robot or mechanism at which the result of another analysis is best."""

    model_config = example(
        analysis="design_optimization",
        design={
            "analysis": "workspace",
            "robot": {"dh": {"convention": "standard", "rows": [{"a": 0.5}, {"a": 0.4, "limits_deg": [0, 150]}]}},
            "sampling": {"method": "grid", "per_joint": 20},
            "task": ["x", "y"],
            "indices": ["manipulability"],
            "voxel_size_m": 0.1,
            "refined_volume": None,
        },
        parameters=[{"name": "forearm", "pointers": ["/robot/dh/rows/1/a"], "bounds": [0.2, 0.5]}],
        objectives=[{"value": "/volume_m3/occupied"}],
        search={"method": "sweep", "steps": 3},
    )

    long_fields: ClassVar[tuple[str, ...]] = ("evaluations",)
    constraints_elsewhere: ClassVar[str] = 'give them to the "design", where they hold for each'

    analysis: Literal["design_optimization"] = "design_optimization"
    """Name of the analysis."""
    design: AnalysedDocument
    """The document of another analysis, of which some numbers vary."""
    parameters: Annotated[tuple[DesignParameter, ...], Field(min_length=1, max_length=MOST_PARAMETERS)]
    """The numbers that vary."""
    constraints: Annotated[tuple[LinearConstraint, ...], BeforeValidator(_linear)] = ()
    """Linear constraints on the parameters; a sweep leaves out designs that break one."""
    objectives: Annotated[tuple[Objective, ...], Field(min_length=1, max_length=MOST_OBJECTIVES)]
    """What is improved: one value, the weighted sum of several, or with the search "pareto" all of them."""
    search: Search = DifferentialEvolution()
    """How designs are chosen."""
    evaluations: Annotated[
        EvaluationsInFile | tuple[tuple[float | None, ...], ...],
        Field(union_mode="left_to_right"),
        BeforeValidator(_evaluations),
    ] = ()
    """Designs that are known and not evaluated again, so that a search goes on where an earlier one ended: rows of
    parameters and values (null: none), or {"path": file.csv}, which is read if it exists and to which every design is
    added at once; local runs only."""

    _document: Any = PrivateAttr(None)

    @model_validator(mode="wrap")
    @classmethod
    def _in_its_own_words(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """The job, whose pointers refer to the design as it was written, which pydantic no longer knows."""
        job = handler(data)
        if job._document is None:
            written = data.get("design") if isinstance(data, Mapping) else None
            canonical = job.design.model_dump(mode="json")
            pointers = [pointer for parameter in job.parameters for pointer in parameter.pointers]
            job._document = in_words_of(written, canonical, pointers) if isinstance(written, Mapping) else canonical
        if problems := [located(field, message) for field, message in job._pointer_conflicts()]:
            raise ValidationError.from_exception_data(cls.__name__, problems)
        return job

    @property
    def design_document(self) -> Any:
        """The document of the design in which all pointers find their numbers: canonical, or as it was written."""
        return deepcopy(self._document)

    @field_serializer("design", mode="wrap", when_used="json")
    def _as_pointed_to(self, design: Any, handler: SerializerFunctionWrapHandler) -> Any:
        return handler(design) if self._document is None else self.design_document

    def arms(self) -> dict[ArmPath, Arm]:
        """The robots of the design."""
        inner: Any = self.design
        return {("design", *path): arm for path, arm in inner.arms().items()}

    def sweeps(self) -> list[Any]:
        """The robots whose joint spaces are sampled, as often as there are designs."""
        inner: Any = self.design
        return inner.sweeps() * self.most_evaluations

    @property
    def most_evaluations(self) -> int:
        """Most designs that the search evaluates."""
        return self.search.evaluations(len(self.parameters))

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        names = [parameter.name for parameter in self.parameters]
        if len(set(names)) < len(names):
            yield "parameters", f"must have different names, not {quoted(names)}"
        for k, constraint in enumerate(self.constraints):
            for name in constraint.coefficients.keys() - set(names):
                yield f"constraints.{k}.coefficients", f'must name parameters, {quoted(names)}, not "{name}"'
        for k, objective in enumerate(self.objectives):
            if objective.value in EXACT and getattr(self.design, "kind", None) != "constant_orientation":
                message = f'"{objective.value}" is of the analysis parallel_workspace, kind "constant_orientation"'
                yield f"objectives.{k}.value", message
        values = [objective.name for objective in self.objectives]
        if len(set(values)) < len(values) or set(values) & set(names):
            yield "objectives", "must be different values, none called like a parameter"
        if isinstance(self.search, ParetoSearch) and len(values) < 2:
            yield "search", 'must not be "pareto" with one objective'
        if isinstance(self.search, GridSweep) and len(self.search.counts(len(names))) != len(names):
            yield "search.steps", f"must be one number, or {len(names)}: one for each parameter"
        elif self.most_evaluations > MOST_EVALUATIONS:
            yield "search", f"takes {self.most_evaluations:.4g} evaluations; at most {MOST_EVALUATIONS:.4g} are allowed"
        columns = len(names) + len(values)
        rows = () if isinstance(self.evaluations, EvaluationsInFile) else self.evaluations
        if any(len(row) != columns or None in row[: len(names)] for row in rows):
            yield "evaluations", f"must be rows of {columns}: the parameters, then the values (null: none)"

    def _pointer_conflicts(self) -> Iterator[tuple[str, str]]:
        used: set[str] = set()
        for k, parameter in enumerate(self.parameters):
            for n, pointer in enumerate(parameter.pointers):
                field = f"parameters.{k}.pointers.{n}"
                try:
                    numbers_at(self._document, pointer)
                except ValueError as error:
                    yield field, str(error)
                    continue
                if pointer in used:
                    yield field, "must not point where another parameter does"
                used.add(pointer)
        try:
            _design(self._document)
        except ValidationError as error:  # two names of one number are pointed to, such as limits and limits_deg
            (problem, *_) = error.errors(include_url=False)
            yield (
                "parameters",
                f"point to fields that do not go together: {path_text('design', *problem['loc'])}: {problem['msg']}",
            )
