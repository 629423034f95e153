"""The other ways to the same numbers: NumPy on batches, loops over MuJoCo and Pinocchio in Python, and in C++.

Each contender is a function of configurations q (N, n) that returns Jacobians (N, 3, n), inertia matrices (N, n, n)
or None, and indices (6 or 12, N), all in float64.
"""

import ctypes
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from wsrender import Robot


def indices_of(A: np.ndarray) -> np.ndarray:
    """The six standard indices (6, N) of matrices A (N, m, n), by NumPy's singular values."""
    sigma = np.linalg.svd(A, compute_uv=False)
    m, product, smallest = sigma.shape[1], sigma.prod(axis=1), sigma[:, -1]
    root, trace = product ** (2 / m), (sigma**2).sum(axis=1)
    with np.errstate(divide="ignore"):
        harmonic = 1 / np.sqrt((sigma**-2.0).sum(axis=1))
    return np.array([product, smallest / sigma[:, 0], smallest, root, harmonic, m * root / trace])


def all_indices(J: np.ndarray, M: np.ndarray | None) -> np.ndarray:
    """Kinematic indices, and the dynamic ones where M (N, n, n) is given."""
    if M is None:
        return indices_of(J)
    return np.concatenate([indices_of(J), indices_of(np.linalg.solve(M, J.transpose(0, 2, 1)).transpose(0, 2, 1))])


class NumpyBatches:
    """Vectorised NumPy over batches of configurations."""

    name = "NumPy, batched"
    batch = 4096

    def __init__(self, robot: Robot):
        self._chain = robot.chain

    def __call__(self, q: np.ndarray, dynamic: bool, batched_svd: bool = True):
        parts = [self._part(q[i : i + self.batch], dynamic) for i in range(0, len(q), self.batch)]
        return tuple(None if part[0] is None else np.concatenate(part, axis=axis)
                     for part, axis in zip(zip(*parts, strict=True), (0, 0, 1), strict=True))  # fmt: skip

    def _part(self, q: np.ndarray, dynamic: bool):
        frames, tip = self._frames(q)
        axes, origins = frames[:, :, :3, 2], frames[:, :, :3, 3]
        moving = self._chain.joint_is_revolute
        J = np.where(moving[:, None], np.cross(axes, tip[:, None] - origins), axes).transpose(0, 2, 1)
        M = self._inertia(frames, axes, origins) if dynamic else None
        return J, M, all_indices(J, M)

    def _frames(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        chain = self._chain
        T = np.broadcast_to(chain.T_world_base, (len(q), 4, 4))
        frames = []
        for i, revolute in enumerate(chain.joint_is_revolute):
            value = chain.joint_scale[i] * q[:, chain.joint_source[i]] + chain.joint_offset[i]
            motion = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
            if revolute:
                c, s = np.cos(value), np.sin(value)
                motion[:, 0, 0], motion[:, 0, 1], motion[:, 1, 0], motion[:, 1, 1] = c, -s, s, c
            else:
                motion[:, 2, 3] = value
            T = T @ chain.T_joint[i] @ motion
            frames.append(T)
        return np.stack(frames, axis=1), (T @ chain.T_tip @ chain.T_tip_tool)[:, :3, 3]

    def _inertia(self, frames: np.ndarray, axes: np.ndarray, origins: np.ndarray) -> np.ndarray:
        """Sum over the links of m Jv^T Jv + Jw^T I Jw."""
        chain = self._chain
        M = np.tile(np.diag(chain.armature), (len(frames), 1, 1))
        for i, mass in enumerate(chain.mass):
            R, center = frames[:, i, :3, :3], frames[:, i, :3, 3] + frames[:, i, :3, :3] @ chain.center_of_mass[i]
            turning = chain.joint_is_revolute[: i + 1, None]
            linear = np.where(
                turning, np.cross(axes[:, : i + 1], center[:, None] - origins[:, : i + 1]), axes[:, : i + 1]
            )
            local = np.where(turning, axes[:, : i + 1], 0.0) @ R
            part = mass * linear @ linear.transpose(0, 2, 1) + local @ chain.inertia[i] @ local.transpose(0, 2, 1)
            M[:, : i + 1, : i + 1] += part
        return M


class Loop:
    """One configuration after the other; the singular values per sample, or of all samples at the end."""

    def __call__(self, q: np.ndarray, dynamic: bool, batched_svd: bool = False):
        N, n = q.shape
        J, M = np.empty((N, 3, n)), np.empty((N, n, n)) if dynamic else None
        values = np.empty((12 if dynamic else 6, N))
        for k, row in enumerate(q):
            self._one(row, J[k], None if M is None else M[k])
            if not batched_svd:
                values[:, k] = all_indices(J[k : k + 1], None if M is None else M[k : k + 1])[:, 0]
        return J, M, all_indices(J, M) if batched_svd else values

    def _one(self, row: np.ndarray, J: np.ndarray, M: np.ndarray | None) -> None:
        raise NotImplementedError


class MujocoLoop(Loop):
    """mj_kinematics, mj_comPos, mj_jac and mj_fullM in a Python loop."""

    name = "MuJoCo, Python loop"

    def __init__(self, robot: Robot):
        import mujoco

        self._mujoco, self._model, self._data = mujoco, robot.model, mujoco.MjData(robot.model)
        self._site = mujoco.mj_name2id(robot.model, mujoco.mjtObj.mjOBJ_SITE, robot.tip_frame)
        joints = [robot.model.joint(name) for name in robot.joint_names]
        self._qpos = np.array([joint.qposadr[0] for joint in joints])
        self._dofs = np.array([joint.dofadr[0] for joint in joints])
        self._jacobian = np.zeros((3, robot.model.nv))
        self._full = np.zeros((robot.model.nv, robot.model.nv))

    def _one(self, row: np.ndarray, J: np.ndarray, M: np.ndarray | None) -> None:
        mujoco, model, data = self._mujoco, self._model, self._data
        data.qpos[self._qpos] = row
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, self._jacobian, None, self._site)
        J[:] = self._jacobian[:, self._dofs]
        if M is not None:
            mujoco.mj_makeM(model, data)
            mujoco.mj_fullM(model, data, self._full)
            M[:] = self._full[self._dofs[:, None], self._dofs]


class PinocchioLoop(Loop):
    """computeJointJacobians, getFrameJacobian and crba in a Python loop, on a model made from the same chain."""

    name = "Pinocchio, Python loop"

    def __init__(self, robot: Robot):
        import pinocchio as pin

        chain, model = robot.chain, pin.Model()
        parent, T_before = 0, chain.T_world_base
        for i, revolute in enumerate(chain.joint_is_revolute):
            joint = pin.JointModelRZ() if revolute else pin.JointModelPZ()
            parent = model.addJoint(parent, joint, pin.SE3(T_before @ chain.T_joint[i]), f"joint{i}")
            inertia = pin.Inertia(float(chain.mass[i]), chain.center_of_mass[i], chain.inertia[i])
            model.appendBodyToJoint(parent, inertia, pin.SE3.Identity())
            T_before = np.eye(4)
        tip = pin.SE3(chain.T_tip @ chain.T_tip_tool)
        self._tip = model.addFrame(pin.Frame("tip", parent, 0, tip, pin.FrameType.OP_FRAME))
        self._pin, self._model, self._data = pin, model, model.createData()
        self._armature = np.diag(chain.armature)

    def _one(self, row: np.ndarray, J: np.ndarray, M: np.ndarray | None) -> None:
        pin, model, data = self._pin, self._model, self._data
        pin.computeJointJacobians(model, data, row)
        pin.updateFramePlacement(model, data, self._tip)
        J[:] = pin.getFrameJacobian(model, data, self._tip, pin.LOCAL_WORLD_ALIGNED)[:3]
        if M is not None:
            upper = np.triu(pin.crba(model, data, row))
            M[:] = upper + np.triu(upper, 1).T + self._armature


class PinocchioCompiled:
    """The same calls in C++ and singular values by Eigen, compiled here for this machine, in about a minute."""

    name = "Pinocchio, C++ loop"

    def __init__(self, robot: Robot):
        self._library, chain = _pinocchio_library(), robot.chain
        T = np.concatenate([chain.T_joint, [chain.T_tip @ chain.T_tip_tool]])
        T[0] = chain.T_world_base @ T[0]
        arrays = [T, chain.mass, chain.center_of_mass, chain.inertia, chain.armature]
        revolute = np.ascontiguousarray(chain.joint_is_revolute, np.uint8)
        self._arm = self._library.make_arm(chain.n, *map(_pointer, [revolute, *arrays]))

    def __call__(self, q: np.ndarray, dynamic: bool, batched_svd: bool = False):
        N, n = q.shape
        J, M, values = np.empty((N, 3, n)), np.empty((N, n, n)) if dynamic else None, np.empty((N, 6 * (1 + dynamic)))
        outputs = [_pointer(J), None if M is None else _pointer(M), _pointer(values)]
        self._library.evaluate(self._arm, _pointer(q), ctypes.c_int64(N), dynamic, *outputs)
        return J, M, values.T


@cache
def _pinocchio_library() -> ctypes.CDLL:
    """pinocchio_loop.cpp with the headers of the packages pin and cmeel-eigen, from the headers alone."""
    compiler = shutil.which("c++")
    prefix = next(
        (Path(at, "cmeel.prefix") for at in sys.path if Path(at, "cmeel.prefix/include/eigen3").is_dir()), None
    )
    if not compiler or not prefix:
        raise ImportError("needs a C++ compiler and the packages pin and cmeel-eigen")
    # As Pinocchio's own CMake configuration asks for.
    definitions = [
        "BOOST_MPL_LIMIT_LIST_SIZE=30",
        "BOOST_MPL_LIMIT_VECTOR_SIZE=30",
        "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    ]
    folders = [prefix / "include", prefix / "include/eigen3"]
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder, "pinocchio_loop.so")
        subprocess.run(
            [compiler, "-w", "-O3", "-march=native", "-DNDEBUG", "-std=c++17", "-shared", "-fPIC"]
            + [f"-D{name}" for name in definitions]
            + [f"-I{path}" for path in folders]
            + [Path(__file__).with_name("pinocchio_loop.cpp"), "-o", library],
            check=True,
        )
        loaded = ctypes.CDLL(str(library))
    loaded.make_arm.restype = ctypes.c_void_p
    loaded.evaluate.argtypes = [ctypes.c_void_p] * 2 + [ctypes.c_int64, ctypes.c_int] + [ctypes.c_void_p] * 3
    return loaded


def _pointer(values: np.ndarray) -> ctypes.c_void_p:
    assert values.flags.c_contiguous
    return values.ctypes.data_as(ctypes.c_void_p)


CONTENDERS = (NumpyBatches, MujocoLoop, PinocchioLoop, PinocchioCompiled)
