"""Robots of a view: chains whose motion the page computes, with the bodies of their links, and what stands around."""

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import BaseModel

from wsrender.documents.environment import Environment, HalfSpace
from wsrender.errors import WsrenderError
from wsrender.results.presentation import imported, presentation_of
from wsrender.results.view.additions import lines
from wsrender.results.view.blobs import Blobs
from wsrender.results.view.manifest import Number, ViewChain, ViewCurves, ViewLink, ViewMesh, ViewRobot
from wsrender.results.view.stance import stance
from wsrender.results.view.surfaces import ColoredMesh, glb
from wsrender.robot import Robot as Arm
from wsrender.robot import robot_of_spec
from wsrender.robot.links import shape_mesh
from wsrender.robot.surroundings import shapes_around
from wsrender.robots.bodies import Bodies
from wsrender.robots.shapes import Shape
from wsrender.volume.table import Table
from wsrender.world.triangles import plate, triangles

_PARSE = "wsrender.analyses.jobs:parse_job"  # of the layer above, which is read by name alone
AROUND = (0.72, 0.62, 0.5)
FLOOR = (0.72, 0.73, 0.74)
MOST_SAMPLES = 200
MOST_MOTIONS = 100  # self-motions whose curves are drawn
STANDS = 1e-6  # of what an arm takes up: joints that go no further stand still


@dataclass(frozen=True, eq=False)
class ShownArm:
    """A robot as a view shows it: its name, where its base stands (4, 4), and what it may be shown in, (K, n).

    ``number``: its place among the robots of its job, some of which may not be shown.
    """

    robot: Arm
    name: str
    T_world_base: np.ndarray
    home: np.ndarray
    configurations: np.ndarray | None = None
    said: str = ""
    number: int = 0


def shown_alone(robot: Arm) -> ShownArm:
    """A robot as it stands, in its `stance`."""
    return ShownArm(robot, robot.name, robot.chain.T_world_base, _stance(robot))


def _stance(robot: Arm) -> np.ndarray:
    """Its `stance`, in which its shapes are apart where they can be read."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said when the robot was loaded
        try:
            bodies = robot.bodies
        except WsrenderError:
            return stance(robot.chain)
    return stance(robot.chain, lambda q: not bodies.overlapping(q[None])[0])


def add_robot(blobs: Blobs, number: int, arm: ShownArm, omitted: list[str]) -> ViewRobot:
    """The entry of a robot; ``omitted`` is told why it has no bodies."""
    bodies = _bodies(arm, omitted)
    chain = arm.robot.chain.geometry if bodies is None else bodies.chain
    entry: ViewRobot = {
        "name": arm.name,
        "chain": chain_entry(arm.robot, chain, arm.T_world_base),
        "links": [] if bodies is None else list(_links(blobs, number, bodies)),
        "home": arm.home.tolist(),
    }
    if arm.configurations is not None and len(arm.configurations):
        entry["samples"] = {"configurations": arm.configurations[:MOST_SAMPLES].tolist(), "said": arm.said}
    return entry


def chain_entry(robot: Arm, chain: Any, T_world_base: np.ndarray) -> ViewChain:
    """The arrays of a chain; its tool is in ``T_tip``, and ``T_tool`` alone. Limits are those of the robot."""
    return {
        "joints": list(robot.joint_names),
        "angle": [bool(each) for each in robot.chain.revolute],
        "lower": _finite(robot.lower_limits),
        "upper": _finite(robot.upper_limits),
        "periodic": [bool(each) for each in robot.chain.periodic],
        "revolute": [bool(each) for each in chain.joint_is_revolute],
        "source": [int(each) for each in chain.joint_source],
        "scale": chain.joint_scale.tolist(),
        "offset": chain.joint_offset.tolist(),
        "T_joint": chain.T_joint.reshape(-1, 16).tolist(),
        "T_tip": (chain.T_tip @ chain.T_tip_tool).ravel().tolist(),
        "T_tool": robot.chain.T_tip_tool.ravel().tolist(),
        "T_base": T_world_base.ravel().tolist(),
    }


def _finite(limits: np.ndarray) -> list[Number]:
    return [float(end) if np.isfinite(end) else None for end in limits]


def _bodies(arm: ShownArm, omitted: list[str]) -> Bodies | None:
    """What is seen of a robot; None where that cannot be read."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said when the robot was loaded
        try:
            return arm.robot._loaded.visuals
        except WsrenderError as error:
            omitted.append(f"the bodies of {arm.name}: {error}")
            return None


def _links(blobs: Blobs, number: int, bodies: Bodies) -> Iterator[ViewLink]:
    """A link for each body that has shapes, in the frame that carries it."""
    by_body: dict[tuple[str, int], list[Shape]] = {}
    for shape in bodies.shapes:
        by_body.setdefault((shape.body, shape.frame), []).append(shape)
    for k, ((name, frame), shapes) in enumerate(by_body.items()):
        content = glb(map(_part, shapes))
        kind = "collision" if all(shape.bits != (0, 0) for shape in shapes) else "visual"
        yield {
            "name": name,
            "frame": frame + 1,
            "geometry": blobs.file(f"robot{number}.link{k}", content),
            "kind": kind,
        }


def _part(shape: Shape) -> ColoredMesh:
    """A shape in the frame that carries it."""
    mesh, T = shape_mesh(shape), shape.T_frame_shape
    return ColoredMesh(
        mesh.vertices @ T[:3, :3].T + T[:3, 3], np.asarray(mesh.faces), tuple(shape.rgba.tolist()), shape.name
    )


def arms_of(
    document: Mapping[str, Any], tables: Mapping[str, Table], robots: Sequence[Arm] | None, omitted: list[str]
) -> list[ShownArm]:
    """The robots of a result as they stand in it: ``robots``, else those of its `shown_job`.

    Where the document says a best base of each they stand there. ``omitted`` is told which cannot be shown, and why.
    """
    job = shown_job(document)
    entries = _entries(document) if job is document.get("job") else []
    found: list[ShownArm] = []
    loaders = (
        [lambda each=each: (each, {}) for each in robots] if robots is not None else _of_job(document, job, omitted)
    )
    bases, names = best_bases(document, len(loaders)), [str(each.get("name", "")) for each in entries]
    for k, load in enumerate(loaders):
        name = names[k] if k < len(names) else ""
        own = {table: held for table, held in tables.items() if _robot_of(table, names) in (name, None)}
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # the result has the notices of its robots among its own warnings
                robot, held = load()
            arm = _stood(robot, held, name, entries[k] if k < len(entries) else {}, bases[k], own)
            found.append(replace(arm, number=k))
        except (WsrenderError, OSError) as error:
            omitted.append(f"robot {name or k + 1}: {error}")
    return found


def shown_job(document: Mapping[str, Any]) -> Any:
    """The canonical document of the job whose robots the view of a result shows, as its analysis says."""
    return presentation_of(document).job(document)


def _of_job(
    document: Mapping[str, Any], job: Any, omitted: list[str]
) -> list[Callable[[], tuple[Arm, Mapping[str, float]]]]:
    """What loads each robot of a job, with the joints that it holds; none of a mechanism."""
    if document.get("mechanism") or job is None:
        return []
    try:
        arms = _parsed(job).arms().values()
    except WsrenderError as error:
        omitted.append(f"robots: the job cannot be read: {error}")
        return []
    return [
        lambda arm=arm: (robot_of_spec(arm.robot, arm.base, arm.tip, arm.held_joints), arm.held_joints) for arm in arms
    ]


def _parsed(job: Any) -> Any:
    """The job of a canonical document; raises DocumentError where it cannot be run again."""
    return imported(_PARSE)(job)


def _entries(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """What the document says of each robot, with the names that it gives them."""
    robots = document.get("robots") or ()
    several: list[Mapping[str, Any]] = [{**each.get("robot", each), "name": each.get("name")} for each in robots]
    return several or ([document["robot"]] if isinstance(document.get("robot"), Mapping) else [])


def _stood(
    robot: Arm,
    held: Mapping[str, float],
    name: str,
    entry: Mapping[str, Any],
    base: np.ndarray | None,
    tables: Mapping[str, Table],
) -> ShownArm:
    if robot.definition:
        raise WsrenderError("a Python class defines it, whose links are not known")
    same = robot.model_hash == entry.get("model_hash") or robot.chain.content_hash == entry.get("chain_hash")
    if "model_hash" in entry and not same:
        raise WsrenderError("its model is another than that of the result")
    where = robot.chain.T_world_base if base is None else base
    said, configurations = next(_configurations(robot, tables), ("", None))
    home = _stance(robot) if configurations is None else configurations[0]
    for joint, value in held.items() if configurations is None else ():
        home[list(robot.joint_names).index(joint)] = value
    return ShownArm(robot, name or robot.name, where, home, configurations, said)


def _robot_of(table: str, names: Iterable[str]) -> str | None:
    """Which robot a table is called after, if any."""
    return max((name for name in names if table.endswith(f"_{name}")), key=len, default=None)


def _configurations(robot: Arm, tables: Mapping[str, Table]) -> Iterator[tuple[str, np.ndarray]]:
    """Tables that hold configurations of a robot."""
    for table, held in tables.items():
        rows = _rows(robot, held)
        rows = rows[np.isfinite(rows).all(axis=1)]
        if len(rows):
            yield table, rows


def _rows(robot: Arm, table: Table) -> np.ndarray:
    """The configurations (K, n) of a table; none where it holds not all joints."""
    columns = [f"q_{joint}" for joint in robot.joint_names]
    if not columns or not all(column in table.columns for column in columns):
        return np.empty((0, len(columns)))
    return np.stack([table[column] for column in columns], axis=1).astype(float)


def self_motions(arm: ShownArm, table: Table, omitted: list[str]) -> list[ViewCurves]:
    """The ways of the joints that move while the tip is held, of each curve of a table of self-motions."""
    q, chain = _rows(arm.robot, table), arm.robot.chain.geometry
    if chain is None or not len(q):
        return []
    found: list[np.ndarray] = []
    starts = np.flatnonzero(table["point"] == 0)
    for rows in np.split(np.arange(len(q)), starts[1:])[:MOST_MOTIONS]:
        joints = chain.frames(q[rows])[:, :-1, :3, 3]
        joints = joints[:, np.ptp(joints, axis=0).max(axis=1) > STANDS * np.ptp(joints, axis=(0, 1)).max()]
        if table["closed"][rows[0]]:
            joints = np.concatenate([joints, joints[:1]])
        T = arm.T_world_base @ np.linalg.inv(chain.T_world_base)
        found += list(np.moveaxis(joints @ T[:3, :3].T + T[:3, 3], 1, 0))
    if len(starts) > MOST_MOTIONS:
        omitted.append(f"{len(starts) - MOST_MOTIONS:,} of {len(starts):,} self-motions")
    return [lines("self_motions", "Self-motions", found)] if found else []


def best_bases(document: Mapping[str, Any], count: int) -> list[np.ndarray | None]:
    """Where the bases of so many robots stand at their best, (4, 4) each; None where the document does not say."""
    best = document.get("best") or {}
    robots = document.get("robots") or ()
    told = [each.get("best") or {} for each in robots] if any("best" in each for each in robots) else []
    if not told:
        told = [best] if "T_world_base" in best else [each for each in best.values() if isinstance(each, Mapping)]
    places = [each.get("T_world_base") for each in told][:count]
    places += [None] * (count - len(places))
    return [None if place is None else np.array(place, float) for place in places]


def environments_in(part: Any) -> Iterator[Environment]:
    """Every environment of a job."""
    if isinstance(part, Environment):
        yield part
    elif isinstance(part, BaseModel):
        for name in type(part).model_fields:
            yield from environments_in(getattr(part, name))
    elif isinstance(part, list | tuple):
        for each in part:
            yield from environments_in(each)


def add_environment(
    blobs: Blobs, document: Mapping[str, Any], lower: np.ndarray, upper: np.ndarray, omitted: list[str]
) -> list[ViewMesh]:
    """What stands around in a result's job as one mesh; ``omitted`` is told why it cannot be shown."""
    if document.get("job") is None:
        return []
    try:
        return surroundings(blobs, environments_in(_parsed(document["job"])), lower, upper)
    except (WsrenderError, OSError) as error:
        omitted.append(f"environment: {error}")
        return []


def surroundings(
    blobs: Blobs, environments: Iterable[Environment], lower: np.ndarray, upper: np.ndarray
) -> list[ViewMesh]:
    """What stands around as one mesh, if anything does; half-spaces are plates below the box lower … upper [m].

    Raises InputError, ModelError for what cannot be had.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        standing = [each for environment in environments for each in shapes_around(environment.items)]
        parts = [_around(each.shape, each.name, lower, upper) for each in dict.fromkeys(standing)]
    data = blobs.file("environment", glb(parts)) if parts else None
    return [{"name": "environment", "label": "Environment", "geometry": data, "role": "environment"}] if data else []


def _around(shape: Any, name: str, lower: np.ndarray, upper: np.ndarray) -> ColoredMesh:
    if isinstance(shape, HalfSpace):
        return ColoredMesh(*plate(shape, lower, upper), FLOOR, name)
    return ColoredMesh(*triangles(shape), AROUND, name)
