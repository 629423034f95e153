"""Drawings of boundaries, read back by another program: DXF by ezdxf, SVG arcs by their endpoint formula."""

import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest

from tests.geometry.planar_arms import boundary, revolute_joints, slide_and_turn, turn_and_slide
from wsrender.geometry.planar.segments import segment_table
from wsrender.results.export import write_dxf, write_svg

ARMS = {
    "lines and arcs": turn_and_slide(),
    "two circles": revolute_joints([8, 5], [(-180, 180)] * 2),
    "notch": slide_and_turn(),
}


@pytest.mark.parametrize("name", ARMS)
def test_dxf_has_the_length_of_the_boundary(name, tmp_path):
    found = boundary(*ARMS[name])
    write_dxf(segment_table(found.segments), tmp_path / "boundary.dxf")
    drawing = ezdxf.readfile(tmp_path / "boundary.dxf")
    assert drawing.units == ezdxf.units.M and not drawing.audit().errors
    length = 0.0
    for entity in drawing.modelspace():
        match entity.dxftype():
            case "LINE":
                length += (entity.dxf.end - entity.dxf.start).magnitude
            case "ARC":
                turn = np.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360)
                length += entity.dxf.radius * turn
            case "CIRCLE":
                length += 2 * np.pi * entity.dxf.radius
    assert length == pytest.approx(found.perimeter, rel=1e-9)
    layers = {entity.dxf.layer for entity in drawing.modelspace()}
    assert layers == ({"outer", "holes"} if name == "two circles" else {"outer"})


def svg_points(data):
    """Points along an SVG path of M, L, A, Z; arcs by the endpoint parametrisation of the SVG standard."""
    at, loops = None, []
    for command, text in re.findall(r"([MLAZ])([^MLAZ]*)", data):
        numbers = [float(x) for x in text.split()]
        if command == "M":
            at = np.array(numbers)
            loops.append([at])
        elif command == "L":
            at = np.array(numbers)
            loops[-1].append(at)
        elif command == "A":
            radius, large, sweep, end = numbers[0], numbers[3], numbers[4], np.array(numbers[5:])
            chord = end - at
            height = np.sqrt(max(radius**2 - chord @ chord / 4, 0)) * (1 if large != sweep else -1)
            center = (at + end) / 2 + height * np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
            first = np.arctan2(*(at - center)[::-1])
            turn = (np.arctan2(*(end - center)[::-1]) - first) % (2 * np.pi) - (0 if sweep else 2 * np.pi)
            angle = first + np.linspace(0, turn, 4000)[1:]
            loops[-1] += list(center + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
            at = end
    return [np.array(loop) for loop in loops]


@pytest.mark.parametrize("name", ARMS)
def test_svg_encloses_the_area(name, tmp_path):
    found = boundary(*ARMS[name])
    write_svg(segment_table(found.segments), tmp_path / "boundary.svg")
    root = ElementTree.parse(tmp_path / "boundary.svg").getroot()
    path = root.find("{http://www.w3.org/2000/svg}path")
    loops = svg_points(path.attrib["d"])
    area = sum((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2 for x, y in (loop.T for loop in loops))
    assert area == pytest.approx(found.area, rel=1e-5)
    left, top, width, height = map(float, root.attrib["viewBox"].split())
    points = np.concatenate(loops)
    assert left < points[:, 0].min() and points[:, 0].max() < left + width
    assert top < -points[:, 1].max() and -points[:, 1].min() < top + height
    assert width < 1.2 * np.ptp(points[:, 0])


WRITER = """
import sys
from tests.results.export.test_drawings import ARMS, boundary, segment_table, write_dxf
write_dxf(segment_table(boundary(*ARMS["notch"]).segments), sys.argv[1])
"""


def test_every_process_writes_the_same_dxf(tmp_path):
    """Whatever the order of its sets, which Python draws anew in each process."""
    contents = set()
    for seed in range(1, 5):
        path, environment = tmp_path / f"{seed}.dxf", {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        command = [sys.executable, "-c", WRITER, str(path)]
        subprocess.run(command, check=True, env={**environment, "PYTHONHASHSEED": str(seed)})
        contents.add(path.read_bytes())
    assert len(contents) == 1
