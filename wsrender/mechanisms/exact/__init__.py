"""Exact workspaces bounded by spheres and planes: method C of Shah, Narayanan and Krovi (2010)."""

from wsrender.mechanisms.exact.faces import Topology
from wsrender.mechanisms.exact.workspace import ExactVolumes, ExactWorkspace, exact_volumes

__all__ = ["ExactVolumes", "ExactWorkspace", "Topology", "exact_volumes"]
