"""Write what a robot's README repeats of its model file: ``python -m tests.library.readme [name …]``, all by default.

It stands between two comments; without them it goes before the sources. All the rest of a README is written by hand.
"""

import math
import re
import sys

import mujoco
import numpy as np

from wsrender.robots import library, load_path
from wsrender.robots.library import LibraryRobot

BEGIN, END = "<!-- made by python -m tests.library.readme -->", "<!-- made until here -->"
SOURCES = "## Source of every number"
SHARE = re.compile(r"Of ([\d ]+) uniform random configurations, ([\d.]+) % collide with the arm itself\.")


def written(text: str, name: str) -> str:
    """A README's text with the tables of the model as it is now."""
    block = f"{BEGIN}\n{tables(name)}\n{END}"
    if BEGIN in text:
        return re.sub(f"{BEGIN}.*?{END}", lambda _: block, text, flags=re.DOTALL)
    return text.replace(SOURCES, f"{block}\n\n{SOURCES}", 1)


def tables(name: str) -> str:
    """Facts, joints, masses and shapes of a library robot, as Markdown."""
    path = library.find(name)
    model = mujoco.MjModel.from_xml_path(str(path))
    robot = next(robot for robot in library.describe() if robot.name == name)
    parts = ["## Model file", _facts(robot), _joints(model, load_path(path).chain), _masses(model), _shapes(model)]
    return "\n\n".join(part for part in parts if part)


def _facts(robot: LibraryRobot) -> str:
    said = {
        "maker": robot.maker,
        "name": robot.full_name,
        "payload": robot.payload_kg and f"{robot.payload_kg:g} kg",
        "reach": robot.reach_m and f"{robot.reach_m:g} m",
        "closed form": robot.closed_form,
        "frames": robot.frames,
        "second source": robot.second_source,
        "other names": ", ".join(robot.aliases),
    }
    return _table(["fact", ""], [[key, value] for key, value in said.items() if value])


def _joints(model: mujoco.MjModel, chain) -> str:
    heads = ["joint", "body in its parent [m]", "turned by (w, x, y, z)", "axis", "range", "velocity", "effort"]
    rows = []
    for k in range(model.njnt):
        body, hinge = model.jnt_bodyid[k], model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE
        scale, unit = (180 / math.pi, "°") if hinge else (1.0, "m")
        limited = model.jnt_limited[k]
        ends = " … ".join(_number(end * scale, 7) for end in model.jnt_range[k])
        velocity = chain.velocity_limits[k]
        effort = None if chain.effort_limits is None else np.max(chain.effort_limits[..., k])
        rows.append([
            model.joint(k).name,
            _vector(model.body_pos[body]),
            _vector(model.body_quat[body]),
            _vector(model.jnt_axis[k]),
            f"{ends} {unit}" if limited else "any",
            f"{_number(velocity, 7)} {'rad/s' if hinge else 'm/s'}" if np.isfinite(velocity) else "—",
            f"{_number(effort, 7)} {'N m' if hinge else 'N'}" if effort is not None and np.isfinite(effort) else "—",
        ])  # fmt: skip
    return _table(heads, rows)


def _masses(model: mujoco.MjModel) -> str:
    heads = ["body", "mass [kg]", "centre of mass [m]", "principal moments [kg m²]"]
    rows = [
        [model.body(k).name, _number(model.body_mass[k]), _vector(model.body_ipos[k]), _vector(model.body_inertia[k])]
        for k in range(1, model.nbody)
        if model.body_mass[k] > 0
    ]
    return _table(heads, rows) if rows else "No masses."


def _shapes(model: mujoco.MjModel) -> str:
    heads = ["body", "shape", "half lengths, or radius and half length [m]", "centre [m]", "turned by (w, x, y, z)"]
    rows = []
    for k in range(model.ngeom):
        kind = mujoco.mjtGeom(model.geom_type[k]).name.removeprefix("mjGEOM_").lower()
        count = {"sphere": 1, "capsule": 2, "cylinder": 2}.get(kind, 3)
        body = model.body(model.geom_bodyid[k]).name
        places = [_vector(model.geom_pos[k], 4), _vector(model.geom_quat[k], 4)]
        rows.append([body, kind, _vector(model.geom_size[k][:count], 4), *places])
    return _table(heads, rows)


def _table(heads: list[str], rows: list[list[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _vector(values: np.ndarray, digits: int = 9) -> str:
    return ", ".join(_number(value, digits) for value in values)


def _number(value: float, digits: int = 9) -> str:
    return f"{round(float(value), digits) + 0.0:.{digits}g}".replace("-", "−")


def collision_share(name: str, count: int) -> float:
    """In how many of uniform random configurations the arm's shapes collide [%]."""
    bodies = load_path(library.find(name)).bodies
    chain, data = bodies.chain, mujoco.MjData(bodies.model)
    q = np.random.default_rng(20240611).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))
    collided = 0
    for qpos in bodies.qpos(q):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(bodies.model, data)
        mujoco.mj_collision(bodies.model, data)
        collided += bool(data.ncon and np.min(data.contact.dist) < 0)
    return 100 * collided / count


def main(names: list[str]) -> None:
    """Write the READMEs of robots, and where one says in how many configurations the arm collides, that too."""
    for name in names or library.names():
        path = library.find(name).parent / "README.md"
        text = written(path.read_text(encoding="utf-8"), name)
        if said := SHARE.search(text):
            share = f"{collision_share(name, int(said[1].replace(' ', ''))):.1f}"
            text = text.replace(said[0], said[0].replace(f"{said[2]} %", f"{share} %"))
        path.write_text(text, encoding="utf-8")
        print(f"{path.parent.name}/{path.name}")


if __name__ == "__main__":
    main(sys.argv[1:])
