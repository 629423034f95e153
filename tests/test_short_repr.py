"""What objects of the public interface say of themselves at a prompt: one line, no arrays, no addresses."""

import inspect
import re
import typing
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

import wsrender as ws
from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.result import Result
from wsrender.robots.bodies import Bodies
from wsrender.robots.chain import Chain
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

LONGEST = 400
NUMBERS = 20_000

# Names in annotations that modules import for type checkers alone.
_FOR_CHECKERS = {each.__name__: each for each in (Bodies, Chain, ExactBoundary, Result, ResultPlots, Table, VolumeData)}


def reached() -> set[type]:
    """wsrender's classes that its public names are, return, or have as a property, and what these do in turn."""
    found: set[type] = set()
    todo: list[Any] = [getattr(ws, name) for name in ws.__all__]
    while todo:
        what = todo.pop()
        if inspect.isclass(what):
            if what.__module__.startswith("wsrender") and not what.__name__.startswith("_") and what not in found:
                found.add(what)
                todo += [member for name, member in vars(what).items() if not name.startswith("_")]
                todo += [_evaluated(text, what) for text in inspect.get_annotations(what).values()]
        elif inspect.isfunction(function := _function(what)):
            todo.append(_evaluated(inspect.unwrap(function).__annotations__.get("return"), inspect.unwrap(function)))
        else:
            todo += typing.get_args(what)
    return found


def _function(member: Any) -> Any:
    for inner in ("fget", "__func__", "func"):
        member = getattr(member, inner, member)
    return member


def _evaluated(annotation: Any, owner: Any) -> Any:
    if not isinstance(annotation, str):
        return annotation
    names = vars(inspect.getmodule(owner)) | _FOR_CHECKERS
    for name in re.findall(r"\w+", annotation):
        names.setdefault(name, Any)
    try:
        return eval(annotation.replace('"', ""), names)
    except Exception:
        return None


def _dumps_arrays(kind: type) -> bool:
    """Whether its text is the one that `object` or `dataclass` writes, of something that may hold arrays."""
    if kind.__repr__ is object.__repr__:
        return True
    written = is_dataclass(kind) and hasattr(kind.__repr__, "__wrapped__")  # by dataclass, against recursion
    return written and any(re.search("ndarray|dict|Mapping|Callable", str(each.type)) for each in fields(kind))


def test_no_class_of_the_interface_leaves_its_text_to_python():
    classes = {each for each in reached() if not issubclass(each, BaseException)}
    assert {ws.Robot, ws.Result, ws.Postures, ExactBoundary, VolumeData, DistributionMap, Table} <= classes
    assert sorted(each.__qualname__ for each in classes if _dumps_arrays(each)) == []


@pytest.fixture(scope="module")
def planar() -> ws.Robot:
    return ws.load_robot(ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.3, limits_deg=(-90, 90))] * 3))


@pytest.fixture(scope="module")
def examples(planar) -> dict[str, Any]:
    arm, table = ws.load_robot("ur5e"), {"x_m": np.zeros(NUMBERS), "name": np.array(["a"] * NUMBERS)}
    q, long = np.zeros((200, 6)), tuple((float(k), 0.0, 0.0) for k in range(1000))
    poses = arm.forward_kinematics(q)
    volume = VolumeData(0.1, (0, 0, 0), np.ones((30, 30, 30), int), {"maximum": {"speed": np.ones((30, 30, 30))}})
    result = ws.indices_at(arm, q, indices=["manipulability"])
    return {
        "ArrayFile": ws.ArrayFile(path="q.npy"),
        "BoundaryBiased": ws.BoundaryBiased(1000, locked={f"joint{k}": 0.1 * k for k in range(50)}),
        "Box": ws.Box(size_m=(1, 2, 3), name="table" * 10),
        "Capsule": ws.Capsule(radius_m=0.1, length_m=0.3),
        "AsyncClient": ws.AsyncClient(),
        "Client": ws.Client(),
        "Converge": ws.Converge(),
        "ConvexMesh": ws.ConvexMesh(vertices_m=long),
        "Criterion": ws.Criterion(least_share=0.9),
        "Cylinder": ws.Cylinder(radius_m=0.1, length_m=0.3),
        "DHRow": ws.DHRow(a=0.3),
        "DHTable": ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.1 * k) for k in range(1, 8)]),
        "Ellipsoid": ws.Ellipsoid(size_m=(1, 2, 3)),
        "Environment": ws.Environment([ws.Sphere(radius_m=0.1, position_m=p) for p in long[:100]]),
        "ExpressionConstraint": ws.ExpressionConstraint("low", lambda x, y, z: z < 1.0),
        "FiveBar": ws.FiveBar(0.1, (0.1, 0.1), (0.2, 0.2)),
        "ForceField": ws.force_field(arm, joint_limits={}),
        "Format": next(iter(_formats())),
        "Grid": ws.Grid([10] * 30),
        "HalfSpace": ws.HalfSpace(name="floor"),
        "HeightField": ws.HeightField(heights_m=[[0.1] * 90] * 90, size_m=(1, 1)),
        "Index": ws.Index("odd", "o", lambda sigma, m, n: sigma[0], "nobody"),
        "Mesh": ws.Mesh("part.stl"),
        "MountJoint": ws.MountJoint(name="rail", joint="prismatic", axis="x", limits=(0, 1)),
        "Option": ws.Option("limit", 1.0),
        "OtherRobot": ws.OtherRobot(robot={"library": "ur5e"}, configuration=[0] * 6),
        "Picture": ws.Picture("odd", lambda plot: None),
        "Polytope": ws.polytope(arm, q[0] + 0.3, "force"),
        "Postures": ws.postures(arm, poses[0, :3, 3] + [0.5, 0, 0.2], [1, 0, 0, 0]),
        "Random": ws.Random(10),
        "Reachability": ws.reachable(arm, poses[:, :3, 3]),
        "Result": result,
        "Robot": arm,
        "Scene": ws.Scene(mjcf="<mujoco>" + "x" * NUMBERS),
        "Sobol": ws.Sobol(1_000_000),
        "Sphere": ws.Sphere(radius_m=0.1),
        "Target": ws.Target(position_m=(1, 2, 3)),
        "TargetTable": ws.TargetTable("targets.csv"),
        "TargetVolume": ws.TargetVolume(box={"lower_m": (0, 0, 0), "upper_m": (1, 1, 1)}, step_m=0.1),
        "Transform": ws.Transform(position_m=(0, 0, 1)),
        "volume": volume,
        "voxels": volume.voxels,
        "map": result.map,
        "plots": result.plot,
        "table": Table(table, {"x_m": "m"}),
        "shapes": arm.shapes,
        "bodies": arm.bodies,
        "chain": arm.chain,
        "boundary": (exact := ws.exact_boundary(planar)),
        "loop": exact.loops[0],
        "nearest": exact.nearest(np.zeros((500, 2))),
    }


def _formats() -> Iterator[Any]:
    from wsrender.results.export.formats import rows

    yield from rows("table")


def test_every_public_class_tells_itself_in_a_line(examples):
    public = {name for name in ws.__all__ if inspect.isclass(kind := getattr(ws, name))
              and not issubclass(kind, BaseException)}  # fmt: skip
    assert public <= examples.keys()
    for name, example in examples.items():
        if name in public:
            assert isinstance(example, getattr(ws, name))
        for text in (repr(example), str(example)):
            assert len(text) <= LONGEST, (name, text)
            assert "\n" not in text and "array(" not in text and " at 0x" not in text, (name, text)


def test_what_they_say():
    told = ws.Sobol(1_000_000), ws.Grid(5, locked={"joint1": 0.1}), ws.Environment([ws.Sphere(radius_m=0.1)] * 1)
    assert [*map(repr, told)] == [
        "Sobol(count=1000000)",
        "Grid(locked={joint1: 0.1}, per_joint=5)",
        "Environment(items=[Sphere(radius_m=0.1)])",
    ]
    volume = VolumeData(0.1, (0, 0, 0), np.ones((2, 3, 4), int), {"maximum": {"speed": np.ones((2, 3, 4))}})
    assert repr(volume) == "<VolumeData: 24 voxels of 0.1 m in (2, 3, 4) of speed>"
    assert repr(Table({"x": np.zeros(1500)}, {"x": "m"})) == "<Table: 1,500 rows of x [m]>"
    found = DistributionMap(np.zeros((7, 3)), {"speed": np.zeros(7)}, {"speed": "m/s"})
    assert repr(found) == "<DistributionMap: 7 samples of speed [m/s]>"
