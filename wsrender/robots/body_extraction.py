"""From a model with its geometry to the bodies of a chain: compiled when they are first asked for."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from wsrender.errors import InputError, ModelError
from wsrender.notices import Notice
from wsrender.robots import branches
from wsrender.robots.bodies import Bodies
from wsrender.robots.chain import Chain
from wsrender.robots.chain_links import Geometry, carriers, inverse, joint_frame, links_of
from wsrender.robots.compiled_model import Purpose, building
from wsrender.robots.couplings import Couplings
from wsrender.robots.frames import Frame, transform
from wsrender.robots.limits import Drive, joint_name
from wsrender.robots.mjcf_model import shown
from wsrender.robots.pairs import Names, collides, pairs_of, pairs_of_child, without
from wsrender.robots.plausibility import long_shapes
from wsrender.robots.shapes import ATTACHED, Shape, shape_of

MOST_SHAPES = 1000  # whose pairs are tried one by one; robots with hands have 200


@dataclass(frozen=True, eq=False)
class BodySource:
    """What the bodies of a chain are made from; see `wsrender.robots.chain_extraction.extract` for its parts.

    ``attached``: shapes that the tip carries, in its frame, as a body fixed to the tip's has them.
    ``excluded``: names of shapes or bodies that a user does not want tested against each other; ``disabled``: of links
    that an SRDF says need not be, which may name links that the robot has not.
    """

    with_geometry: Callable[[Purpose], tuple[mujoco.MjModel, tuple[Notice, ...]]]
    chain: Chain
    base: Frame
    tip: Frame
    couplings: Couplings
    reference: np.ndarray
    leaders: list[int]
    drives: list[Drive]
    aside: list[Drive]
    field: str
    attached: tuple[Shape, ...] = ()
    excluded: tuple[Names, ...] = ()
    disabled: tuple[Names, ...] = ()

    @cached_property
    def collision(self) -> Bodies:
        """The shapes that may collide. Raises ModelError where one cannot be had, InputError for ``excluded`` names."""
        bodies = self._bodies("collision", collides)
        shapes = bodies.shapes
        geoms = [shape.geom for shape in shapes if shape.geom != ATTACHED]
        pairs = np.concatenate(
            [pairs_of(bodies.model, geoms), pairs_of_child(bodies.model, geoms, self.tip.body, len(shapes))]
        )
        own = np.array([not shape.surroundings for shape in shapes], bool)
        with_shapes = {shape.body for shape in shapes}
        disabled = [names for names in self.disabled if with_shapes.issuperset(names)]
        around = pairs[own[pairs].sum(axis=1) == 1]
        pairs = without(pairs[own[pairs].all(axis=1)], shapes, disabled, "srdf")
        pairs = without(pairs, shapes, self.excluded, "exclude")
        notices = (*bodies.notices, *self._unknown(bodies.model), *long_shapes(self.chain, shapes))
        return replace(bodies, pairs=pairs, notices=notices, around=around)

    def _unknown(self, model: mujoco.MjModel) -> list[Notice]:
        known = {model.body(body).name for body in range(model.nbody)}
        if not (unknown := sorted({name for names in self.disabled for name in names} - known)):
            return []
        message = f"the SRDF names {len(unknown)} links that the robot does not have: {', '.join(unknown[:4])}"
        return [Notice("srdf_unknown_links", message, field="robot.srdf")]

    @cached_property
    def visual(self) -> Bodies:
        """The shapes that are seen, in no pairs; those whose files are not there are told in the notices."""
        return self._bodies("visual", _seen)

    def _bodies(self, purpose: Purpose, chosen: Callable[[mujoco.MjModel], list[int]]) -> Bodies:
        with building(self.field):
            model, notices = self.with_geometry(purpose)
            moving = [*self.drives, *self._moving_aside(model)]
            order = branches.serial_order(model, [drive.joint for drive in moving], len(self.drives))
            geometry = Geometry.at_reference(model, moving, self.reference, self.base, self.tip)
            joints = [(moving[number], sign) for number, sign in order]
            chain = replace(self.chain, has_inertia=False, with_branches=None, **links_of(model, geometry, joints))
            numbers = [drive.joint if sign > 0 else -1 for drive, sign in joints]
            geoms = chosen(model)
            if len(geoms) > MOST_SHAPES:
                raise ModelError(self.field, f"the model has {len(geoms)} shapes; at most {MOST_SHAPES} are supported")
            shapes = self._shapes(model, geometry, geoms, numbers, purpose)
            shapes += self._attached(model, geometry, shapes, numbers)
        addresses = np.array([model.jnt_qposadr[joint] if joint >= 0 else -1 for joint in numbers])
        pairs = np.zeros((0, 2), int)
        return Bodies(model, chain, shapes, pairs, self.reference, addresses, notices, tip=self.tip.body)

    def _moving_aside(self, model: mujoco.MjModel) -> list[Drive]:
        """Leaders and followers off the path, each of which moves with a coordinate of the chain."""
        followers, refused = branches.followers_aside(model, self.couplings, self.leaders, self.drives)
        if refused:
            raise refused[0]
        aside = [*self.aside, *followers]
        moving = branches.moving_bodies(model, aside, self.base)
        if len(moving) < len(aside):
            names = ", ".join(joint_name(model, drive.joint) for drive in aside if drive not in moving)
            raise ModelError(self.field, f"the base is moved by {names}, a coordinate of its own chain: its shapes too")
        return moving

    def _shapes(
        self, model: mujoco.MjModel, geometry: Geometry, geoms: list[int], joints: list[int], purpose: Purpose
    ) -> tuple[Shape, ...]:
        """The shapes of ``geoms``, each in the frame of that of the chain's ``joints`` which carries its body."""
        data, carrier = geometry.data, carriers(model, joints)
        still = np.eye(4)  # of a joint that undoes another, which carries nothing
        frames = [joint_frame(model, data, joint) if joint >= 0 else still for joint in joints]
        frames.append(geometry.base)  # number -1
        shapes = []
        for geom in geoms:
            frame = int(carrier[model.geom_bodyid[geom]])
            T = transform(data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3))
            hull = purpose == "collision"
            shapes.append(shape_of(model, geom, frame, inverse(frames[frame]) @ T, hull, self.field))
        return tuple(shapes)

    def _attached(
        self, model: mujoco.MjModel, geometry: Geometry, shapes: tuple[Shape, ...], joints: list[int]
    ) -> tuple[Shape, ...]:
        """The shapes that the tip carries. Raises InputError for a name that the model's have."""
        frame = int(carriers(model, joints)[self.tip.body])
        T = inverse(joint_frame(model, geometry.data, joints[frame])) @ geometry.tip
        taken = {name for shape in shapes for name in (shape.name, shape.body)}
        for number, shape in enumerate(self.attached):
            if shape.name in taken:
                message = f"must be another than that of a shape or body of the model, {shape.name!r}"
                raise InputError(f"tool_shapes.{number}.name", message)
        return tuple(replace(shape, frame=frame, T_frame_shape=T @ shape.T_frame_shape) for shape in self.attached)


def _seen(model: mujoco.MjModel) -> list[int]:
    kinds = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)
    return [geom.id for geom in shown(map(model.geom, range(model.ngeom))) if mujoco.mjtGeom(geom.type[0]) not in kinds]
