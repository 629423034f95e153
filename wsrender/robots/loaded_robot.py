"""A robot as loaded: the compiled model and the chain taken from it."""

from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.notices import Notice
from wsrender.robots.bodies import Bodies
from wsrender.robots.body_extraction import BodySource
from wsrender.robots.chain import Chain
from wsrender.robots.limits import Drive


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
    body_source: BodySource
    gravity: tuple[float, ...] | None = None  # (3,) [m/s²] that the model states
    notices: tuple[Notice, ...] = ()  # what was odd about the model
    aside: tuple[Drive, ...] = ()  # off the path: leaders, and what follows coordinates
    branches: tuple[Drive, ...] = ()  # those of them that move a body

    @property
    def bodies(self) -> Bodies:
        """The shapes that may collide; see `BodySource.collision`."""
        return self.body_source.collision.placed_as(self.chain)

    @property
    def visuals(self) -> Bodies:
        """The shapes that are seen; see `BodySource.visual`."""
        return self.body_source.visual.placed_as(self.chain)

    @property
    def coupling(self) -> np.ndarray:
        """(L, n) derivative of the displacements of the chain's joints by the configuration."""
        return self.chain.coupling

    @property
    def moving(self) -> tuple[np.ndarray, np.ndarray]:
        """Addresses (D,) in ``qvel`` of all that moves, and C (D, n) with M(q) = Cᵀ M_dof C over them.

        Those are the joints of the chain, then those on other branches.
        """
        rows = np.zeros((len(self.branches), self.chain.n))
        for row, drive in zip(rows, self.branches, strict=True):
            row[drive.source] = drive.scale
        dofs = self.model.jnt_dofadr[[drive.joint for drive in self.branches]]
        return np.concatenate([self.dof_addresses, dofs]), np.concatenate([self.coupling, rows])

    def set_configuration(self, data: mujoco.MjData, q: np.ndarray) -> None:
        """Writes configuration ``q`` (n,) [rad or m] to ``data.qpos``, coupled joints on all branches included.

        Everything else takes its reference; velocities are left alone.
        """
        chain = self.chain
        displacement = chain.joint_scale * np.asarray(q)[chain.joint_source] + chain.joint_offset
        data.qpos[:] = self.reference_qpos
        data.qpos[self.qpos_addresses] = self.model.qpos0[self.qpos_addresses] + displacement
        for drive in self.aside:
            address = self.model.jnt_qposadr[drive.joint]
            data.qpos[address] = self.model.qpos0[address] + drive.scale * q[drive.source] + drive.offset
