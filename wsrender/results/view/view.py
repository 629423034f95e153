"""The view of a result or of a robot: a manifest, and blobs by name."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.documents.environment import Environment
from wsrender.errors import InputError
from wsrender.results import drawing
from wsrender.results.drawing.faces import Faces
from wsrender.results.export.headline import headline_lines, warning_lines
from wsrender.results.export.text import sampling_text
from wsrender.results.presentation import imported, presentation_of
from wsrender.results.view import parts
from wsrender.results.view.additions import Additions
from wsrender.results.view.blobs import Blobs, Encoding
from wsrender.results.view.container import message, within
from wsrender.results.view.edited import Edited
from wsrender.results.view.manifest import Manifest, Role, ViewMesh
from wsrender.results.view.robots import (
    ShownArm,
    add_environment,
    add_robot,
    arms_of,
    self_motions,
    shown_alone,
    surroundings,
)
from wsrender.results.view.surfaces import MOST_TRIANGLES, ColoredMesh, glb
from wsrender.results.view.volumes import MOST_VOXELS, add_volumes
from wsrender.results.view.words import said
from wsrender.robot import Robot, as_robot, robot_of_spec
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh

    from wsrender.results.result import Result

PICTURES = "plots/"
_ROLES: dict[str, Role] = {
    "intersection": "shared",
    "patches": "boundary",
    "boundary": "boundary",
    "refined": "refined",
}
_ROOM = 0.1  # of the edges of what is shown, around it
_SMALLEST = 0.5  # [m] half the edge of the box around a robot alone


@dataclass(frozen=True, eq=False)
class View:
    """What a page draws: ``manifest``, which JSON can hold, and ``blobs``, bytes by name, made when asked for."""

    manifest: Manifest
    blobs: Mapping[str, bytes] = field(default_factory=dict)

    def for_file(self, budget: int) -> "View":
        """The view with its blobs deflated, of which those left out that do not fit in ``budget`` bytes, which is told.

        Raises InputError for a budget below 0.
        """
        if budget < 0:
            raise InputError("budget", f"must be at least 0 bytes, not {budget}")
        return View(*within(self.manifest, self.blobs, budget))

    def to_file_bytes(self, budget: int) -> bytes:
        """`for_file` as one `message`, whose header holds the manifest under its name."""
        kept = self.for_file(budget)
        return message({"manifest": kept.manifest}, kept.blobs)


def edited_view(edited: Edited) -> View:
    """The view of what is edited. Raises InputError, ModelError for what cannot be had."""
    robot = None if edited.robot is None else robot_of_spec(edited.robot, edited.base, edited.tip)
    return _alone(robot, edited.environment)


def robot_view(robot: Any) -> View:
    """The view of a robot alone, what `wsrender.load_robot` takes or a Robot.

    Raises InputError for what is none, ModelError.
    """
    return _alone(as_robot(robot), None)


def _alone(robot: Robot | None, environment: Environment | None) -> View:
    blobs, omitted, arms, sticks = Blobs(), [], [], []
    if robot is not None and robot.definition:
        omitted.append(f"the motion of {robot.name}: a Python class defines it, whose links are not known")
        sticks = parts.skeletons(robot.skeleton(robot.chain.within(0.25)), 1, [])
    elif robot is not None:
        arms = [shown_alone(robot)]
    lower, upper = _box((), arms)
    manifest = _manifest(
        title="" if robot is None else robot.name,
        robots=[add_robot(blobs, k, arm, omitted) for k, arm in enumerate(arms)],
        skeletons=sticks,
        meshes=surroundings(blobs, [environment] if environment else [], lower, upper),
        omitted=omitted,
    )
    return View(manifest, blobs)


def view_of(
    result: "Result",
    robots: Sequence[Any] | None = None,
    *,
    encoding: Encoding = "float16",
    most_voxels: int = MOST_VOXELS,
    pictures: str = "",
) -> View:
    """The view of a result of any analysis.

    ``robots``: those of the result, in its order, where its job cannot load them. Channels are held in every encoding
    (uint8, float16, float32); the manifest names that of ``encoding``, or single precision where half would not tell
    values apart. Blocks of more than ``most_voxels`` are shown in larger voxels. ``pictures`` stands before the paths
    of the result's pictures. What cannot be shown is told in ``omitted``.

    Raises InputError for robots that are none.
    """
    blobs, omitted, document = Blobs(), [], result.document
    plot, tables = result.plot, result.tables
    presentation = presentation_of(document)
    shown: Additions = Additions() if presentation.view is None else imported(presentation.view)(plot)
    given = None if robots is None else [as_robot(robot) for robot in robots]
    arms = arms_of(document, tables, given, omitted)
    volumes = {"volume": result.volume, **result.volumes, **shown.volumes}
    entries = [add_robot(blobs, k, arm, omitted) for k, arm in enumerate(arms)]
    names = [str(each.get("name")) for each in document.get("robots") or ()]
    own = [] if arms else parts.skeletons(result.skeleton, plot.arms if not names else 1, names)
    held_volumes = add_volumes(blobs, volumes, encoding, most_voxels)
    faces = {name: drawing.faces_of(mesh, tables.get("surfaces")) for name, mesh in result.meshes.items()}
    meshes = list(_meshes(blobs, result.meshes, {**faces, **shown.faces}, omitted))
    lower, upper = _box(volumes.values(), arms)
    lines = [parts.arcs_and_lines(name, tables[name], shown.in_plane)
             for name in presentation.drawings if name in tables]  # fmt: skip
    motions = self_motions(arms[0], tables["self_motions"], omitted) if arms and "self_motions" in tables else []
    base = next((arm.T_world_base for arm in arms), None)
    manifest = _manifest(
        title=sampling_text(document),
        analysis=str(document.get("analysis", "")),
        headline=list(_facts(document)),
        warnings=warning_lines(document),
        job=document.get("job"),
        robots=entries,
        skeletons=[*own, *shown.skeletons],
        volumes=held_volumes,
        meshes=[*meshes, *add_environment(blobs, document, lower, upper, omitted)],
        points=parts.add_points(blobs, plot.samples, tables, encoding, omitted),
        glyphs=parts.add_arrows(blobs, [*parts.vector_fields(volumes), *shown.arrows], omitted),
        curves=[*lines, *shown.curves, *motions],
        maps=parts.add_maps(blobs, tables, base, encoding),
        plots=[
            *parts.histograms(plot.samples, result.volume),
            *parts.convergence(document),
            *parts.curve_plots(tables),
            *shown.plots,
        ],
        mapping=shown.mapping,
        pictures=[
            {"name": row.name, "label": row.caption or said(row.name), "url": f"{pictures}{PICTURES}{row.name}.png"}
            for row in plot.pictures
        ],
        omitted=omitted,
    )
    return View(manifest, blobs)


def _manifest(**given: Any) -> Manifest:
    """A manifest, empty but for what is given; plain JSON values, as it will be read."""
    empty: dict[str, Any] = {"format": 1, "title": "", "analysis": "", "job": None, "mapping": None}
    lists = ("headline", "warnings", "robots", "skeletons", "volumes", "meshes", "points", "glyphs", "curves", "maps")
    empty |= {name: [] for name in (*lists, "plots", "pictures", "omitted")}
    return json.loads(json.dumps(empty | given, allow_nan=False))


def _facts(document: dict[str, Any]) -> Iterator[dict[str, str]]:
    """Headline and facts of the analysis, a line each."""
    for line in headline_lines(document):
        name, colon, text = line.partition(": ")
        yield {"label": said(name) if colon else "", "value": text if colon else line}
    presentation = presentation_of(document)
    if presentation.measures(document):
        yield from ({"label": said(name), "value": text} for name, text in presentation.facts(document))


def _meshes(
    blobs: Blobs, meshes: "Mapping[str, trimesh.Trimesh]", faces: Mapping[str, Faces], omitted: list[str]
) -> Iterator[ViewMesh]:
    for k, (name, mesh) in enumerate(meshes.items()):
        if len(mesh.faces) > MOST_TRIANGLES:
            omitted.append(f"{name}: it has {len(mesh.faces):,} triangles; at most {MOST_TRIANGLES:,} are shown")
            continue
        content = glb(_parts_of(mesh, faces[name]))
        role = _ROLES.get(name, "surface")
        yield {"name": name, "label": said(name), "geometry": blobs.file(f"mesh{k}", content), "role": role}


def _parts_of(mesh: "trimesh.Trimesh", faces: Faces) -> Iterator[ColoredMesh]:
    """A mesh by the faces that its triangles belong to, each in its colour: the mesh's own, or that of the faces."""
    visual = mesh.visual
    number = np.asarray(mesh.face_attributes.get("surface", faces.number)).astype(np.int64)
    own: Any = np.asarray(visual.face_colors)[:, :3] / 255.0 if visual.kind == "face" else None  # type: ignore
    numbers = np.unique(number)
    for k in numbers:
        rows = np.flatnonzero(number == k)
        color = tuple(own[rows[0]]) if own is not None else faces.colors.get(int(k), next(iter(faces.colors.values())))
        if len(numbers) == 1:
            used, local = slice(None), faces.triangles
        else:
            used, local = np.unique(faces.triangles[rows], return_inverse=True)
        label = faces.labels.get(int(k), f"part {k}" if len(numbers) > 1 else "")
        yield ColoredMesh(faces.vertices[used], local.reshape(-1, 3), tuple(map(float, color)), label)


def _box(volumes: Iterable[VolumeData | None], arms: Sequence[ShownArm]) -> tuple[np.ndarray, np.ndarray]:
    """Corners (3,) [m] of a box around what is shown, with some room."""
    corners = [arm.T_world_base[:3, 3] + sign * max(_SMALLEST, _reach(arm)) for arm in arms for sign in (-1.0, 1.0)]
    for volume in volumes:
        if volume is not None and len(volume.voxels.cells):
            corners += [volume.origin_m, volume.origin_m + np.array(volume.shape) * volume.voxel_size_m]
    points = np.array(corners or [[-1.0] * 3, [1.0] * 3])
    lower, upper = points.min(axis=0), points.max(axis=0)
    return lower - _ROOM * (upper - lower), upper + _ROOM * (upper - lower)


def _reach(arm: ShownArm) -> float:
    reach = arm.robot.chain.reach
    return reach if np.isfinite(reach) else 0.0
