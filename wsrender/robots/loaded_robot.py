"""A robot as loaded: the compiled model and the chain taken from it."""

from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.notices import Notice
from wsrender.robots.chain import Chain


@dataclass(frozen=True, eq=False)
class LoadedRobot:
    """A compiled model with the chain from its base to its tip.

    Joint i of the chain (L joints, held ones left out) has its displacement at ``qpos_addresses[i]`` of
    ``MjData.qpos`` and its velocity at ``dof_addresses[i]`` of ``qvel``; ``reference_qpos`` (nq,) is the
    configuration in which everything off the chain is held.
    """

    model: mujoco.MjModel
    chain: Chain
    source_hash: str  # SHA-256 of the source text, hexadecimal
    qpos_addresses: np.ndarray  # (L,) int
    dof_addresses: np.ndarray  # (L,) int
    reference_qpos: np.ndarray  # (nq,)
    notices: tuple[Notice, ...] = ()  # what was odd about the model

    @property
    def coupling(self) -> np.ndarray:
        """(L, n) derivative of the displacements by the configuration: M(q) = couplingᵀ M_dof coupling."""
        chain = self.chain
        matrix = np.zeros((len(chain.joint_source), chain.n))
        matrix[np.arange(len(matrix)), chain.joint_source] = chain.joint_scale
        return matrix

    def set_configuration(self, data: mujoco.MjData, q: np.ndarray) -> None:
        """Writes configuration ``q`` (n,) [rad or m] to ``data.qpos``, coupled joints included.

        Everything off the chain takes its reference; velocities are left alone.
        """
        chain = self.chain
        displacement = chain.joint_scale * np.asarray(q)[chain.joint_source] + chain.joint_offset
        data.qpos[:] = self.reference_qpos
        data.qpos[self.qpos_addresses] = self.model.qpos0[self.qpos_addresses] + displacement
