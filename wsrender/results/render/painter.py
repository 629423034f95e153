"""Draws a scene with PyVista. Runs in a process of its own: see ``wsrender.results.render.process``."""

import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

from wsrender.results.render.scene import Camera, Cloud, Dots, DrawnScene, DrawnSurface, Lines, Plates, Rods

OVERSAMPLING = 2  # pixels drawn per pixel of the picture, each way: edges without steps
PEELS = 6  # translucent layers sorted per pixel; more change little at the usual transparency
SHINE = 0.45  # how much of an arm is seen through what hides it
SMOOTHING = {"n_iter": 20, "pass_band": 0.1}  # Taubin 1995: rounds off voxels, keeps the volume


def main() -> None:
    """Draw the scene that comes on standard input; write the picture, uint8 (height, width, 3), as npy."""
    scene, path = pickle.load(sys.stdin.buffer)
    np.save(Path(path), draw(scene), allow_pickle=False)


def draw(scene: DrawnScene) -> np.ndarray:
    """The picture of a scene, uint8 (height, width, 3)."""
    width, height = scene.size
    plotter: Any = pv.Plotter(
        off_screen=True, lighting="three lights", window_size=[width * OVERSAMPLING, height * OVERSAMPLING]
    )
    plotter.set_background("white")
    plotter.render_window.SetMultiSamples(0)  # with samples, sorted translucent layers stay empty
    if any(isinstance(layer, DrawnSurface) and layer.alpha < 1 for layer in scene.layers):
        plotter.enable_depth_peeling(PEELS)  # only where needed: it leaves clouds out
    for layer in scene.layers:
        _PAINTERS[type(layer)](plotter, layer)
    _look(plotter.camera, scene.camera, _depth(scene))
    picture = _reduced(plotter.screenshot(None, return_img=True))
    arms = _arms_alone(plotter, scene)
    plotter.close()
    shine = SHINE * arms[:, :, 3:] / 255
    return np.round((1 - shine) * picture + shine * arms[:, :, :3]).astype(np.uint8)


def _arms_alone(plotter: Any, scene: DrawnScene) -> np.ndarray:
    """The arms without what hides them, (height, width, 4), clear where there is none."""
    plotter.clear_actors()
    for layer in scene.layers:
        if isinstance(layer, Rods):
            _rods(plotter, layer)
    return _reduced(plotter.screenshot(None, return_img=True, transparent_background=True))


def _reduced(picture: np.ndarray) -> np.ndarray:
    """The drawn pixels averaged to those of the picture."""
    height, width, channels = picture.shape
    blocks = picture.reshape(height // OVERSAMPLING, OVERSAMPLING, width // OVERSAMPLING, OVERSAMPLING, channels)
    return blocks.mean(axis=(1, 3))


def _look(view: Any, camera: Camera, depth: float) -> None:
    view.focal_point = camera.center
    view.position = camera.center - camera.forward * 2 * depth
    view.up = camera.up
    view.parallel_projection = True
    view.parallel_scale = camera.half_height
    view.clipping_range = (0.5 * depth, 3.5 * depth)


def _depth(scene: DrawnScene) -> float:
    """A length [m] beyond the distance of anything from the centre of the picture."""
    lines = [layer.ends.reshape(-1, 3) for layer in scene.layers if isinstance(layer, Lines)]
    corners = np.concatenate([*lines, scene.camera.center[None]])
    return 1.2 * float(np.linalg.norm(corners - scene.camera.center, axis=1).max()) + scene.camera.half_height


def _surface(plotter: Any, surface: DrawnSurface) -> None:
    mesh: Any = pv.PolyData.from_regular_faces(surface.vertices, surface.faces)
    if surface.smooth:
        mesh = mesh.smooth_taubin(**SMOOTHING)
    if surface.colors is None:
        shading = {"opacity": surface.alpha, "smooth_shading": surface.smooth, "ambient": 0.25, "diffuse": 0.8}
        plotter.add_mesh(mesh, color=surface.color, **shading)
    else:
        mesh["colors"] = surface.colors
        # Unlit: a shade would stand for another value of the colour bar.
        plotter.add_mesh(mesh, scalars="colors", rgb=True, opacity=surface.alpha, lighting=False)


def _plates(plotter: Any, plates: Plates) -> None:
    quads = np.arange(4 * len(plates.corners)).reshape(-1, 4)
    mesh = pv.PolyData.from_regular_faces(plates.corners.reshape(-1, 3), quads)
    mesh.cell_data["colors"] = plates.colors
    plotter.add_mesh(mesh, scalars="colors", rgb=True, lighting=False)


def _points(plotter: Any, points: Dots) -> None:
    cloud = pv.PolyData(points.positions)
    cloud["colors"] = points.colors
    size = points.size * OVERSAMPLING
    plotter.add_mesh(cloud, scalars="colors", rgb=True, point_size=size, lighting=False, style="points")


def _cloud(plotter: Any, cloud: Cloud) -> None:
    """Voxels as a light-absorbing medium; VTK draws from centre to centre, so a clear layer goes around them."""
    size, levels = cloud.voxel_size, np.pad(cloud.levels, 1)
    grid = pv.ImageData(dimensions=levels.shape, spacing=(size, size, size), origin=cloud.origin - size / 2)
    grid["levels"] = levels.ravel(order="F")
    actor = plotter.add_volume(grid, scalars="levels", mapper="gpu", show_scalar_bar=False, clim=[0, 255], shade=False)
    actor.mapper.SetAutoAdjustSampleDistances(False)
    actor.mapper.SetSampleDistance(size / 2)  # VTK's own is a metre
    color, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
    for level, (red, green, blue, alpha) in enumerate(cloud.table.tolist()):
        color.AddRGBPoint(level, red, green, blue)
        opacity.AddPoint(level, alpha)
    actor.prop.SetColor(color)
    actor.prop.SetScalarOpacity(opacity)
    actor.prop.SetScalarOpacityUnitDistance(size)
    actor.prop.SetInterpolationTypeToNearest()


def _lines(plotter: Any, lines: Lines) -> None:
    segments = np.arange(2 * len(lines.ends)).reshape(-1, 2)
    mesh = pv.PolyData(lines.ends.reshape(-1, 3), lines=np.insert(segments, 0, 2, axis=1).ravel())
    plotter.add_mesh(mesh, color=lines.color, line_width=lines.width * OVERSAMPLING, lighting=False)


def _rods(plotter: Any, rods: Rods) -> None:
    metal = {"smooth_shading": True, "ambient": 0.3, "diffuse": 0.75, "specular": 0.2}
    for start, end in zip(rods.points[:-1], rods.points[1:], strict=True):
        if (length := float(np.linalg.norm(end - start))) > 0:
            rod = pv.Cylinder(center=(start + end) / 2, direction=end - start, radius=rods.radius, height=length)
            plotter.add_mesh(rod, color=rods.color, **metal)
    edge = 5 * rods.radius
    foot = pv.Cube(center=rods.points[0], x_length=edge, y_length=edge, z_length=edge)
    plotter.add_mesh(foot, color=rods.color, ambient=0.3)
    for joint in rods.points[1:-1]:
        plotter.add_mesh(pv.Sphere(2.0 * rods.radius, joint), color=rods.joint_color, **metal)
    plotter.add_mesh(pv.Sphere(2.6 * rods.radius, rods.points[-1]), color=rods.tip_color, **metal)


_PAINTERS = {DrawnSurface: _surface, Plates: _plates, Dots: _points, Cloud: _cloud, Lines: _lines, Rods: _rods}
