"""A robot compiled by MuJoCo."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender import notices
from wsrender.documents.robot import RobotSpec, Transform
from wsrender.errors import InputError, MissingInertiaError, ModelError
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.notices import Notice
from wsrender.robot.body_tables import pair_table, shape_table
from wsrender.robot.tool_shapes import attached
from wsrender.robots import (
    described,
    library,
    load,
    load_dh,
    load_library,
    load_mjcf,
    load_path,
    load_uploaded,
    load_urdf,
    named_models,
    xml_source,
)
from wsrender.robots.closed_form import form_of
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.plausibility import NO_LIMITS
from wsrender.volume.table import Table

_WINDOW = "wsrender.window"  # of a layer above, which is read by name alone

if TYPE_CHECKING:
    import mujoco

    from wsrender.robots.bodies import Bodies
    from wsrender.robots.loaded_robot import LoadedRobot
    from wsrender.robots.loading import Source


@keywords
class Robot:
    """A serial chain of a compiled model, from its base frame to its end effector.

    Positions are in the world frame [m]; a configuration ``q`` has shape (n,) or (N, n), in radians and
    metres, in the order of ``joint_names``; results always have the leading axis N (1 for a single one).

    >>> rows = [{"a": 0.3, "limits_deg": [-180, 180]}, {"a": 0.2, "limits_deg": [-180, 180]}]
    >>> arm = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    >>> q = [0, np.pi / 2]  # the forearm at a right angle
    >>> arm.forward_kinematics(q)[0, :3, 3].round(9).tolist()
    [0.3, 0.2, 0.0]
    >>> arm.jacobian(q)[0, :2].round(9).tolist()
    [[-0.2, -0.2], [0.3, 0.0]]
    """

    def __init__(
        self,
        loaded: "LoadedRobot",
        spec: RobotSpec | None = None,
        name: str | None = None,
        base: str | None = None,
        tip: str | None = None,
    ):
        self._loaded = loaded
        self.spec = spec
        self.base, self.tip = base, tip  # as asked for; base_frame and tip_frame are what was found
        self.name = name or loaded.chain.name

    @property
    def chain(self) -> Kinematics:
        """Joint names and limits, and how the joints move the end effector; its ``geometry`` is a model's Chain."""
        return self._loaded.chain

    @property
    def model(self) -> "mujoco.MjModel":
        """The compiled MuJoCo model."""
        return self._loaded.model

    @property
    def definition(self) -> str | None:
        """The Python class that defines the robot, ``module.Class``; None where a model does."""
        return None

    @property
    def model_hash(self) -> str:
        """SHA-256 of the model's source text."""
        return self._loaded.source_hash

    @property
    def stated_gravity(self) -> tuple[float, ...] | None:
        """Gravity (3,) [m/s²] that the model states, which jobs do not use; None where it states none."""
        return None if self.definition else self._loaded.gravity

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What was odd about the model when it was loaded; results hold it among their warnings."""
        return self._loaded.notices

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the n joints, base to tip."""
        return self.chain.joint_names

    @property
    def lower_limits(self) -> np.ndarray:
        """Lower joint limits [rad or m], (n,)."""
        return self.chain.lower_limits

    @property
    def upper_limits(self) -> np.ndarray:
        """Upper joint limits [rad or m], (n,)."""
        return self.chain.upper_limits

    @property
    def base_frame(self) -> str:
        """Name of the frame that the chain starts from."""
        return self.chain.base_frame

    @property
    def tip_frame(self) -> str:
        """Name of the end-effector frame."""
        return self.chain.tip_frame

    @property
    def has_inertia(self) -> bool:
        """Whether the model has link inertias, so that dynamic indices exist."""
        return self.chain.has_inertia

    @property
    def closed_form(self) -> str | None:
        """The class of arms that closed-form inverse kinematics solves this one by, in words; None: of none.

        Told by the axes, joints that are held left out: "spherical wrist, axes 2 and 3 parallel", "three parallel
        axes", "SCARA", "planar arm"; a spherical "shoulder" is a wrist at the base. Of seven joints, where six have one
        wherever the one at an end stands: "ball search along joint 7 over a closed form (…)". Of six without a
        wrist, of which axes 4 and 5 meet: "ball search along joint 6, axes 1 and 2 intersecting, axes 4 and 5
        intersecting". Of hinges that miss a class by 1e-5 rad and reaches at most, as calibrated ones do: "three
        parallel axes, but for 9e-6 m and 4e-6 rad", by which poses of the arm and one of the class differ at most.
        """
        form = form_of(self.chain)
        return form and form.name

    @property
    def bodies(self) -> "Bodies":
        """The shapes that may collide, where they stand and in which pairs; meshes are read when it is first asked for.

        Raises ModelError, as `shapes` and `pairs` do, where a shape cannot be had, InputError for a Python class.
        """
        return self._bodies("bodies")

    @property
    def shapes(self) -> Table:
        """Shapes that may collide, a row each; none for a model that states none.

        ``name``, ``body`` and ``kind`` (plane, sphere, capsule, ellipsoid, cylinder, box or mesh) as text; ``frame``
        int, the joint of the chain that carries it, -1 for the base; ``position_m`` (S, 3) and ``quat_wxyz`` (S, 4) in
        that frame; ``size_m`` (S, 3) as MuJoCo means it, of a mesh the edges of a box around it; ``vertices`` int of
        its convex hull; ``surroundings`` bool, whether it belongs to the world of the model's file.
        """
        return shape_table(self.bodies)

    @property
    def pairs(self) -> Table:
        """Pairs of the robot's own shapes that may collide, as text: ``first``, ``second``, and the body of each.

        MuJoCo's rules choose them (see `wsrender.robots.pairs`), less what an SRDF or ``exclude`` names.
        """
        return pair_table(self.bodies)

    @property
    def visuals(self) -> Table:
        """Shapes that are seen, as `shapes` has those that may collide; ``rgba`` (S, 4) 0 … 1.

        Those in MuJoCo's visible groups, or a URDF's visuals; where it has none, the shapes that may collide. What has
        no file is left out, with a ModelWarning.
        """
        return shape_table(self._bodies("visuals"))

    def _bodies(self, which: str) -> "Bodies":
        if self.definition:
            raise InputError("robot", f"{self.name} is defined by a Python class, which has no shapes")
        try:
            found: Bodies = getattr(self._loaded, which)
        except InputError as error:
            raise error.at(_field_of_arm(error.field, self.spec)) if self.spec else error from None
        notices.warn(found.notices, ModelWarning)
        return found

    def forward_kinematics(self, q: Any, *, precision: str = "float64", device: str = "auto") -> np.ndarray:
        """Poses of the end effector in the world, (N, 4, 4)."""
        return self._kinematics(q, precision, device).pose

    def jacobian(self, q: Any, *, precision: str = "float64", device: str = "auto") -> np.ndarray:
        """Geometric Jacobians (N, 6, n): rows linear then angular, at the end effector, in world axes."""
        return self._kinematics(q, precision, device).jacobian

    def inertia_matrix(
        self, q: Any, *, method: str = "kernel", precision: str = "float64", device: str = "auto"
    ) -> np.ndarray:
        """Joint-space inertia matrices (N, n, n) [kg m², kg m, kg], armature included.

        ``method`` "mujoco" evaluates them with MuJoCo itself. Raises MissingInertiaError for a model
        without inertias.
        """
        if not self.has_inertia:
            raise MissingInertiaError("inertia_matrix", f"the model of {self.name} has no link inertias")
        if method == "mujoco":
            return self.mujoco_inertia(configuration_rows(q, self.chain.n))
        if method != "kernel":
            raise InputError("method", f'{method!r} is not allowed; "kernel" or "mujoco" is')
        inertia = self._kinematics(q, precision, device, with_inertia=True).inertia
        assert inertia is not None
        return inertia

    def mujoco_inertia(self, q: np.ndarray) -> np.ndarray:
        """Inertia matrices (N, n, n) float64 at ``q`` (N, n), by MuJoCo's composite rigid body algorithm."""
        import mujoco

        loaded, model = self._loaded, self.model
        data = mujoco.MjData(model)
        full = np.zeros((model.nv, model.nv))
        addresses, coupling = loaded.moving
        dofs = np.ix_(addresses, addresses)
        out = np.empty((len(q), self.chain.n, self.chain.n))
        for i, row in enumerate(q):
            loaded.set_configuration(data, row)
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            mujoco.mj_makeM(model, data)
            mujoco.mj_fullM(model, data, full)
            out[i] = coupling.T @ full[dofs] @ coupling
        return out

    def given_inertia(self, inertia: str) -> Callable[[np.ndarray], np.ndarray] | None:
        """What the host computes inertia matrices with, for the field ``inertia`` of a job; None: kernels do."""
        return self.mujoco_inertia if inertia == "mujoco" else None

    def placed(self, placement: Transform) -> "Robot":
        """The same robot with its base frame elsewhere in the world."""
        loaded = replace(self._loaded, chain=self._loaded.chain.placed(placement.matrix()))
        spec = self.spec and self.spec.model_copy(update={"placement": placement})
        return Robot(loaded, spec, self.name, self.base, self.tip)

    def changed(
        self,
        *,
        limits: Mapping[str, tuple[float, float]] | None = None,
        placement: np.ndarray | None = None,
        tool: np.ndarray | None = None,
    ) -> "Robot":
        """The same robot with other limits of joints by name [rad or m], base frame in the world, or tool, (4, 4) each.

        As `load_robot` takes them, without compiling the model again. Raises InputError for an unknown joint, an empty
        range, and for what a Python class fixes.
        """
        chain = self._loaded.chain.limited(limits or {}).placed(placement, tool)
        spec = self.spec
        if spec:
            degrees = {name: ends for name, ends in spec.limits_deg.items() if name not in (limits or {})}
            stated = {"limits": {**spec.limits, **(limits or {})}, "limits_deg": degrees}
            given = {"placement": placement, "tool": tool}
            stated |= {name: transform_of(T) for name, T in given.items() if T is not None}
            spec = spec.model_copy(update=stated)
        return Robot(replace(self._loaded, chain=chain), spec, self.name, self.base, self.tip)

    def held(self, values: Mapping[str, float]) -> "Robot":
        """The same robot with joints, by name, held at a value [rad or m]."""
        chain = self._loaded.chain.held(values)
        kept = tuple(notice for notice in self.notices if notice.code != NO_LIMITS or chain.endless)
        return Robot(replace(self._loaded, chain=chain, notices=kept), self.spec, self.name, self.base, self.tip)

    def skeleton(self, q: Any) -> np.ndarray:
        """World positions [m] of base, joint origins and tip, (N, L + 2, 3), for drawing the arm.

        The base stands at the first joint where its frame is many reaches away, as that of a map may be.
        """
        chain, rows = self._loaded.chain, configuration_rows(q, self.chain.n)
        foot = np.broadcast_to(chain.foot, (len(rows), 1, 3))
        return np.concatenate([foot, chain.frames(rows)[..., :3, 3]], axis=1)

    def view(self, port: int = 0, block: bool | None = None) -> Any:
        """Show the robot in the viewer: in a notebook as a widget, else in a tab of the browser (a `LocalView`).

        ``block``: return when the program is told to stop (Ctrl-C); by default in a script, not at a prompt. Raises
        InputError for a port in use, MissingExtraError in a notebook without the extra ``notebook``.
        """
        return import_module(_WINDOW).show(self, port, block)

    _repr_mimebundle_ = mime_bundle

    def _kinematics(self, q, precision, device, with_inertia=False):
        from wsrender.engine import evaluate_kinematics

        rows = configuration_rows(q, self.chain.n)
        return evaluate_kinematics(self.chain, rows, with_inertia, precision, device)

    @cached_property
    def _text(self) -> str:
        return f"{self.name}: {len(self.joint_names)} joints, {self.base_frame} to {self.tip_frame}"

    def __repr__(self) -> str:
        return f"<Robot {self._text}>"


def configuration_rows(q: Any, n: int, field: str = "q") -> np.ndarray:
    """Configurations as float64 (N, n); InputError names what is wrong with ``field``."""
    try:
        rows = np.asarray(q, np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(field, f"is not an array of numbers: {error}") from error
    if rows.ndim == 1 and len(rows) == n:
        rows = rows[None]
    if rows.ndim != 2 or rows.shape[1] != n:
        raise InputError(field, f"has shape {np.shape(q)}; ({n},) or (N, {n}) is needed")
    finite = np.isfinite(rows).all(axis=1)
    if not finite.all():
        raise InputError(field, f"row {int(np.argmin(finite))} has a value that is not finite")
    return rows


@keywords
def load_robot(
    source: "Source",
    *,
    base: str | None = None,
    tip: str | None = None,
    name: str | None = None,
    placement: Any = None,
    tool: Any = None,
    limits: Mapping[str, Any] | None = None,
    limits_deg: Mapping[str, Any] | None = None,
    effort_limits: Mapping[str, float] | None = None,
    velocity_limits: Mapping[str, float] | None = None,
    length_unit_m: float | None = None,
    reference: Mapping[str, float] | None = None,
    srdf: str | Path | None = None,
    exclude: Sequence[tuple[str, str]] = (),
    tool_shapes: Sequence[Any] = (),
    mount: Sequence[Any] = (),
    packages: Mapping[str, str | Path] | None = None,
    xacro: Mapping[str, Any] | None = None,
    entry: str | None = None,
) -> Robot:
    """Load a robot: a name, the path or text of an MJCF (.xml), URDF or SDF file, a DH table, MjSpec or MjModel.

    A name is one of the library, or what Corke, MATLAB or ssik call such a robot; or of a collection:
    "menagerie:universal_robots_ur5e", "robot_descriptions:ur5e_mj_description" (extra ``models``; both download at
    first use), "example-robot-data:ur5_robot".
    A path may be that of a xacro file, which is expanded with the arguments ``xacro`` by name. ``package://`` leads to
    the folder that ``packages`` names, one above the file, in ROS_PACKAGE_PATH or in the ament index. Or a path is that
    of a ZIP or folder of a model with its files: ``entry`` names the model in it where several could be meant.
    ``base`` and ``tip`` name a site, body or link (default: the world, and the site "tool" or the only end).
    ``placement`` is the base frame in the world and ``tool`` the tool point in the tip frame, each a
    `Transform`, its fields as a dict, or a (4, 4) array. ``limits`` {joint: (lower, upper)} [rad or m] (or
    ``limits_deg``) go before the model's, as do ``effort_limits`` {joint: value} [N m or N] and ``velocity_limits``
    [rad/s or m/s]; ``length_unit_m`` is the model's unit of length [m]: 0.001 converts millimetres, 1 confirms metres.
    ``reference`` {joint: value} [rad or m] says where joints beside the chain stand, such as those of another arm;
    others of them stand at the model's zero. ``srdf`` is the path or text of an SRDF, whose disabled pairs of links do
    not collide; nor do those of ``exclude``, pairs of names of shapes, or of bodies
    for all shapes on them. ``tool_shapes``, of tool and payload, are carried by the tip, in its frame: `Box`, `Sphere`,
    `Cylinder`, `Capsule`, `Ellipsoid`, `Mesh` or their fields; they collide as a body of the name tool that is fixed to
    the tip's would. ``mount``: joints that carry the robot's base, the first of its chain, a rail or a torso: each a
    `MountJoint` or its fields, from the ground up. What is odd about a model is a ModelWarning, and among the robot's
    ``notices``.
    Raises InputError, ModelError for a malformed or unsupported model, FrameNotFoundError listing the frames.

    >>> ws.load_robot("ur5e")
    <Robot ur5e: 6 joints, world to tool>
    >>> rows = [{"a": 0.3, "limits_deg": [-90, 90]}, {"a": 0.2, "limits_deg": [-180, 180]}]
    >>> arm = ws.load_robot(ws.DHTable(convention="standard", rows=rows), limits={"joint1": (0.0, 1.0)})
    >>> arm.upper_limits.round(3).tolist()
    [1.0, 3.142]
    """
    source, xacro, packages = named_models.resolved(source, xacro, packages)
    kind, value = described(source)
    options: dict[str, Any] = {"base": base, "tip": tip, "name": name}
    placement, tool = _as_transform(placement), _as_transform(tool)
    options |= {"placement": _matrix(placement), "tool": _matrix(tool)}
    given: dict[str, Any] = {"limits": limits or {}, "limits_deg": limits_deg or {}, "length_unit_m": length_unit_m}
    given |= {"effort_limits": effort_limits or {}, "velocity_limits": velocity_limits or {}}
    given |= {"reference": reference or {}, "srdf": _srdf_text(srdf), "exclude": exclude}
    given |= {"tool_shapes": tool_shapes, "mount": mount, "xacro": xacro or {}, "entry": entry}
    given["packages"] = {package: str(folder) for package, folder in (packages or {}).items()}
    if kind == "library":
        value = library.canonical(value)
    stated = RobotSpec(**{kind: value}, **given)
    loaded = load(source, **options, **_corrections(stated), **_reading(stated))
    spec = stated.model_copy(update={"placement": transform_of(placement), "tool": transform_of(tool)})
    return Robot(loaded, spec, name, base, tip)


def robot_of_spec(
    spec: RobotSpec, base: str | None = None, tip: str | None = None, held: Collection[str] = ()
) -> Robot:
    """The robot of a job document; that joints have no limits which the job holds is not warned of.

    Raises ModelError; InputError for a model that only a server has. Fields are those of an arm in a document.
    """
    options = {
        "held": held,
        "base": base,
        "tip": tip,
        "placement": spec.placement.matrix() if spec.placement else None,
        "tool": spec.tool.matrix() if spec.tool else None,
    }
    loaders = {
        "library": load_library,
        "dh": load_dh,
        "mjcf": load_mjcf,
        "urdf": load_urdf,
        "path": load_path,
        "model": load_uploaded,
    }
    try:
        source = getattr(spec, spec.source)
        loaded = loaders[spec.source](source, **options, **_corrections(spec), **_reading(spec))
    except InputError as error:
        raise error.at(_field_of_arm(error.field, spec)) from None
    return Robot(loaded, spec, base=base, tip=tip)


def _field_of_arm(field: str, spec: RobotSpec) -> str:
    """Where in an arm of a document stands what a loader calls so: its ``model`` is the robot's source."""
    if field in ("base", "tip") or field.startswith("robot."):
        return field
    return f"robot.{spec.source if field == 'model' else field}"


def _corrections(spec: RobotSpec) -> dict[str, Any]:
    """What a document says of a model that the model itself does not, or not rightly."""
    names = (
        "limits",
        "limits_deg",
        "effort_limits",
        "velocity_limits",
        "length_unit_m",
        "reference",
        "srdf",
        "exclude",
        "mount",
    )
    found = {name: getattr(spec, name) for name in names}
    return found | ({"attached": attached(spec.tool_shapes)} if spec.tool_shapes else {})


def _reading(spec: RobotSpec) -> dict[str, Any]:
    """How the file is read that a document names, if it names one."""
    if spec.path is not None:
        return {"packages": spec.packages, "xacro": spec.xacro, "entry": spec.entry}
    return {"entry": spec.entry} if spec.model is not None else {}


def _srdf_text(srdf: str | Path | None) -> str | None:
    if srdf is None or (isinstance(srdf, str) and srdf.lstrip("\ufeff \t\r\n").startswith("<")):
        return srdf
    try:
        return xml_source.read(Path(srdf), "srdf").decode()
    except UnicodeDecodeError as error:
        raise ModelError("srdf", f"{Path(srdf).name} is not UTF-8: {error.reason}") from error


def _as_transform(value: Any) -> Any:
    return Transform(**value) if isinstance(value, Mapping) else value


def _matrix(transform: Any) -> np.ndarray | None:
    if transform is None:
        return None
    return transform.matrix() if isinstance(transform, Transform) else np.asarray(transform, np.float64)


def transform_of(value: Any) -> Transform | None:
    """The document form of a placement or tool."""
    if value is None or isinstance(value, Transform):
        return value
    from scipy.spatial.transform import Rotation

    T = np.asarray(value, np.float64)
    x, y, z, w = Rotation.from_matrix(T[:3, :3]).as_quat()
    px, py, pz = T[:3, 3].tolist()
    return Transform(position_m=(px, py, pz), quat_wxyz=(w, x, y, z))
