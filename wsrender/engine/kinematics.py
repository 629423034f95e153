"""Batched forward kinematics, Jacobian and inertia matrix of a chain."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import warp as wp
from wsrender_kernels.pointwise import kinematics_kernel

from wsrender.engine.devices import devices_of, thread_count
from wsrender.engine.evaluation import REAL, chain_model, device_array, drive
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

BATCH = 1 << 20
LEAST_SHARE = 1 << 14  # configurations that are worth a thread


@dataclass(frozen=True, eq=False)
class EvaluatedKinematics:
    """Poses (N, 4, 4), Jacobians (N, 6, n) and, where asked, inertia matrices (N, n, n), in the world frame.

    Poses of a robot far from the world's origin are float64 in any precision: no other holds them.
    """

    pose: np.ndarray
    jacobian: np.ndarray
    inertia: np.ndarray | None


def evaluate_kinematics(
    chain: Kinematics,
    q: np.ndarray,
    with_inertia: bool = False,
    precision: str = "float64",
    device: str = "auto",
    *,
    threads: int | None = None,
) -> EvaluatedKinematics:
    """Kinematics at configurations ``q`` (N, n) [rad or m], in batches of bounded memory on so many CPU threads.

    Those of a robot that is defined by a Python class are its own, in float64, without inertia.
    """
    if (geometry := chain.geometry) is None:
        return EvaluatedKinematics(chain.poses(q), chain.jacobians(q), None)
    target = devices_of(device)[0]
    workers = 1 if target.is_cuda else thread_count(threads)
    size = min(BATCH, max(LEAST_SHARE, -(-len(q) // workers)))
    batches = [q[first : first + size] for first in range(0, max(len(q), 1), size)]

    def evaluate(batch: np.ndarray) -> EvaluatedKinematics:
        return _evaluate(geometry, batch, with_inertia, precision, target)

    if len(batches) == 1:
        return evaluate(q)
    with ThreadPoolExecutor(workers) as pool:
        parts = list(pool.map(evaluate, batches))
    return EvaluatedKinematics(
        np.concatenate([p.pose for p in parts]),
        np.concatenate([p.jacobian for p in parts]),
        np.concatenate([p.inertia for p in parts if p.inertia is not None]) if with_inertia else None,
    )


def evaluate_poses(
    chain: Kinematics, q: np.ndarray, precision: str = "float64", device: str = "auto", *, threads: int | None = None
) -> np.ndarray:
    """Poses (N, 4, 4) alone: the Jacobians of a robot that is defined by a Python class may cost many times as much."""
    if chain.geometry is None:
        return chain.poses(q)
    return evaluate_kinematics(chain, q, False, precision, device, threads=threads).pose


def _evaluate(
    chain: Chain, q: np.ndarray, with_inertia: bool, precision: str, device: wp.Device
) -> EvaluatedKinematics:
    real, n, origin = REAL[precision], chain.n, chain.origin
    chain = chain.dynamic if with_inertia else chain
    pose = wp.empty((len(q), 12), dtype=real, device=device)
    jacobian = wp.empty((len(q), 6, n), dtype=real, device=device)
    inertia = wp.empty((len(q) if with_inertia else 0, n, n), dtype=real, device=device)
    if len(q):
        launch(
            loaded(kinematics_kernel(real, n, *drive(chain), with_inertia), device),
            dim=len(q),
            inputs=[chain_model(chain.relative_to(origin), precision), device_array(q, real, device)],
            outputs=[pose, jacobian, inertia],
            device=device,
        )
    T = np.zeros((len(q), 4, 4), np.float64 if origin.any() else wp.dtype_to_numpy(real))
    T[:, :3, :] = pose.numpy().reshape(-1, 4, 3).transpose(0, 2, 1)
    T[:, :3, 3] += origin
    T[:, 3, 3] = 1
    return EvaluatedKinematics(T, jacobian.numpy(), inertia.numpy() if with_inertia else None)
