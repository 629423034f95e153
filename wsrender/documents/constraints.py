"""Constraints on configurations in a job document: each by its name."""

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field, StrictBool

from wsrender.documents.document import Document
from wsrender.documents.environment import Bounds, Environment, HalfSpace, Sphere
from wsrender.documents.quantities import NonNegativeNumber, Number, is_none, quoted, real
from wsrender.documents.robot import Excluded, Inertia, least_moment
from wsrender.documents.transform import Quaternion, Transform, Vector

_ROTATIONS = ("quat_wxyz", "rpy_deg", "euler_xyz_deg")


class RegionChoice(Document):
    """Where the tip may be: in all of the shapes that are given."""

    box: Bounds | None = None
    """A box along the world's axes; null: none."""
    sphere: Sphere | None = None
    """A ball; null: none."""
    half_space: HalfSpace | None = None
    """One side of a plane; null: none."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.box is None and self.sphere is None and self.half_space is None:
            yield "box", "must be given, or a sphere or a half_space"


class OrientationChoice(Document):
    """How the tip stands in the world: an axis of it near a direction, or its whole rotation near another."""

    axis: Vector = (0.0, 0.0, 1.0)
    """An axis in the tip's frame; any length but zero."""
    toward: Vector | None = None
    """The direction in the world near it, the middle of a cone; any length but zero. Null: a rotation is given."""
    quat_wxyz: Quaternion | None = None
    """Instead, a rotation of the tip in the world: quaternion, scalar first; any length but zero, it is normalised."""
    rpy_deg: Vector | None = None
    """Instead, roll, pitch, yaw about fixed x, y, z as in URDF: R = Rz(yaw) Ry(pitch) Rx(roll) [°]."""
    euler_xyz_deg: Vector | None = None
    """Instead, angles about the moving x, y, z: R = Rx Ry Rz [°]."""
    within_deg: Annotated[float, Field(ge=0, le=180), BeforeValidator(real)]
    """Largest angle between the two directions, or of the rotation from one to the other [°]."""

    @property
    def rotation(self) -> Transform:
        """The rotation, where one is given."""
        return Transform.model_construct(**{name: getattr(self, name) for name in _ROTATIONS})

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        given = [name for name in _ROTATIONS if getattr(self, name) is not None]
        if self.toward is None and not given:
            yield "toward", f"must be given, or one of {quoted(_ROTATIONS)}"
        for name in ("axis", "toward"):
            if given and name in self.model_fields_set and getattr(self, name) is not None:
                yield name, f'must not be given together with "{given[0]}", which says the whole rotation'
            elif (vector := getattr(self, name)) is not None and not 1e-6 < math.hypot(*vector) < 1e6:
                yield name, f"must not have length {math.hypot(*vector):g}: it says no direction"
        yield from self.rotation.conflicts()


class Apart(Document):
    """Shapes that keep apart."""

    margin_m: NonNegativeNumber = 0.0
    """Least distance [m]; 0: they may touch."""
    exclude: Excluded = ()
    """Pairs of names, of shapes or of bodies for all shapes on them, that may come nearer."""


class TorqueChoice(Document):
    """Joints hold the arm and a payload within their torque limits."""

    payload_kg: NonNegativeNumber = 0.0
    """A mass that the tip carries [kg]."""
    payload_com_m: Vector = (0.0, 0.0, 0.0)
    """Where it is in the tip's frame [m]."""
    payload_inertia_kg_m2: Annotated[Inertia | None, Field(exclude_if=is_none)] = None
    """Its inertia about there, axes of the tip's frame: [ixx, iyy, izz] or these and ixy, ixz, iyz [kg m²]; null: it is
    a point."""
    acceleration_m_s2: NonNegativeNumber = 0.0
    """Acceleration of the tip that is held in every direction of the linear task too [m/s²]; 0: at rest."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (inertia := self.payload_inertia_kg_m2) is not None:
            if not self.payload_kg:
                yield "payload_inertia_kg_m2", 'must not be given without "payload_kg": nothing is carried'
            if (least := least_moment(inertia)) < 0:
                yield "payload_inertia_kg_m2", f"must not have a negative principal moment, here {least:g} kg m²"


def _apart(value: Any) -> Any:
    """The choice of a constraint that may be given as true."""
    if value is not None and not isinstance(value, bool | Mapping | Apart | TorqueChoice):
        raise ValueError("must be true, false, null or an object")
    return {} if value is True else value


def _switch(choice: Any) -> BeforeValidator:
    """A validator of a choice that may be given as true, all by default, or false, none."""

    def switched(value: Any) -> Any:
        return _apart(value) if value is not False else None

    return BeforeValidator(switched, json_schema_input_type=choice | StrictBool | None)


def _options(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): real(option) for name, option in value.items()}
    if isinstance(value, bool):
        return value
    raise ValueError("must be true, false or numbers by option")


Options = Annotated[StrictBool | dict[str, Number], BeforeValidator(_options)]
"""Of a constraint that another package or the user adds: whether it acts, or its options."""


class Constraints(Document):
    """Which configurations are admitted: those that all constraints admit.

    Further names are those of constraints that were added with `register_constraint`: true, or their options.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Options]  # type: ignore[assignment]

    region: RegionChoice | None = None
    """Where the tip may be; null: anywhere."""
    orientation: OrientationChoice | None = None
    """How the tip may stand; null: in any way."""
    self_collision: Annotated[Apart | None, _switch(Apart)] = None
    """The robot's own shapes keep apart; true: they may touch; null: they are not asked for."""
    environment: Annotated[Apart | Literal[False] | None, BeforeValidator(_apart)] = None
    """How far the robot keeps from the job's ``environment``; null: it may touch it; false: it is only drawn."""

    torque: Annotated[TorqueChoice | None, _switch(TorqueChoice)] = None
    """Torque limits hold the arm and what it carries; true: without a payload; null: they are not asked for."""

    @property
    def added(self) -> dict[str, dict[str, float]]:
        """Options of the added constraints that act, by name."""
        acting = {name: each for name, each in (self.__pydantic_extra__ or {}).items() if each is not False}
        return {name: options if isinstance(options, dict) else {} for name, options in acting.items()}


class ArmsConstraints(Constraints):
    """Those of several arms: what every arm must satisfy by itself, and what they must together."""

    arms_collision: Annotated[Apart | None, _switch(Apart), Field(exclude_if=is_none)] = None
    """Two arms that reach a point together keep apart from each other, in configurations that all else admits; names
    of shapes and bodies are led by that of their arm and a stroke. true: they may touch; null: they are not asked
    for."""

    @property
    def of_each(self) -> Constraints:
        """Those of an arm by itself."""
        given = {name: getattr(self, name) for name in self.model_fields_set - {"arms_collision"}}
        return Constraints.model_construct(**given)


class Constrained(Document):
    """The field of every arm whose configurations may be constrained."""

    constraints: Constraints | None = None
    """Which configurations are admitted; null: all."""
    environment: Environment | None = None
    """What stands around, which the robot's shapes do not enter; null: nothing."""
    gravity_m_s2: Annotated[Vector | None, Field(exclude_if=is_none)] = None
    """Gravity in the world, whatever the model says [m/s²]; null: 9.81 along -z."""

    @property
    def asks_for_shapes(self) -> bool:
        """Whether shapes of the robot keep apart from something."""
        choice = self.constraints
        return bool(self.environment or (choice and (choice.self_collision or choice.environment)))
