"""What a person asks of the engine behind the served page, by the mouse on the picture."""

import json
import zlib
from base64 import urlsafe_b64encode

import httpx2
import matplotlib as mpl
import numpy as np
import psutil
import pytest
from scipy.spatial.transform import Rotation
from wsrender_server.local_server import LocalServer
from wsrender_server.streams.view_process import NICE

import wsrender as ws
from tests.viewer.watched import JOB, Watched, clicked, opened, pixels, settle, spots, tip, until
from tests.viewer.written import looking

UR5E = ws.load_robot("ur5e")


@pytest.fixture(scope="module")
def searched(client) -> str:
    """The id of a job that keeps the best samples of voxels."""
    return client.submit(JOB | {"best_sample": "manipulability"}).wait().id


def test_the_robot_moves_to_the_best_sample_of_a_clicked_voxel(
    watched: Watched, client: ws.Client, searched: str
) -> None:
    opened(watched, f"/job/{searched}")
    home = tip(watched)
    cell, _ = clicked(watched)
    result = client.job(searched).result()
    volume = result.volume
    assert volume is not None
    row = int(np.searchsorted(volume.voxels.cells, np.ravel_multi_index(cell, volume.shape)))
    number = int(volume.voxels.best["manipulability"][row])
    watched.page.get_by_text(f"Best posture: sample {number}.").wait_for()
    corner = volume.voxel_size_m * (np.array(cell) + volume.first_voxel)
    until(lambda: np.abs(tip(watched) - home).max() > 1e-3)
    reached = tip(watched)
    assert (reached > corner - 1e-6).all()
    assert (reached < corner + volume.voxel_size_m + 1e-6).all()
    q = ws.configuration_of(result, number)
    assert np.abs(reached - UR5E.forward_kinematics(q)[0, :3, 3]).max() < 1e-9


def test_the_tool_is_dragged_to_where_it_can_be_and_to_where_it_cannot(watched: Watched, searched: str) -> None:
    """Green within reach, where the tip goes; red with the reason beyond it."""
    target, half, q = np.zeros(3), 1.5, [0.3, -1.4, 1.6, -0.4, 1.1, 0.2]
    T = UR5E.forward_kinematics(q)[0]
    opened(watched, f"/job/{searched}", camera=looking(target, half), configurations=[q])
    page, mouse = watched.page, watched.page.mouse
    page.get_by_label("Show Volume").uncheck()
    page.get_by_role("button", name="Drag the tool").click()
    axis = T[:3, np.abs(T[[0, 2], :3]).sum(axis=0).argmax()]  # of the tool, the one that is seen longest
    metre = spots(watched, [axis], [0, 0, 0], half)[0] - spots(watched, [[0, 0, 0]], [0, 0, 0], half)[0]
    along = metre / np.linalg.norm(metre)

    def drag(length: float) -> None:
        """By pixels along the axis, at its arrow."""
        settle(watched)
        start = spots(watched, tip(watched), target, half)[0] + 45 * along
        mouse.move(*start)
        mouse.down()
        for share in (0.3, 0.7, 1.0):
            mouse.move(*(start + share * length * along))
        mouse.up()

    def said(state: str) -> tuple[str, list[int]]:
        """The words and their colour."""
        words = page.locator(f"[data-reach={state}]")
        words.wait_for()
        color = words.evaluate("each => getComputedStyle(each).color").removeprefix("rgb(").removesuffix(")")
        return words.inner_text(), [int(each) for each in color.split(",")]

    drag(-16)
    expected = T[:3, 3] - 16 / np.linalg.norm(metre) * axis
    until(lambda: np.abs(tip(watched) - expected).max() < 1e-3)
    words, (red, green, blue) = said("reachable")
    assert words.split() == ["Tool:", "Reachable"]
    assert green > 1.5 * max(red, blue)
    drag(-250)
    words, (red, green, blue) = said("unreachable")
    assert words.split(maxsplit=1) == ["Tool:", "Unreachable: out of reach, proven"]
    assert red > 1.5 * max(green, blue)


def test_all_postures_of_the_tool_are_stepped_through(watched: Watched, client: ws.Client, searched: str) -> None:
    """As many as the library finds, each once, while the tip stands; the last is followed by the first."""
    q = [0.3, -1.4, 1.6, -0.4, 1.1, 0.2]
    found = ws.postures(UR5E, UR5E.forward_kinematics(q)[0])
    opened(watched, f"/job/{searched}", configurations=[q])
    page, place, seen = watched.page, tip(watched), []
    page.get_by_role("button", name="Other postures").click()
    for number in [*range(1, len(found) + 1), 1]:
        page.get_by_text(f"{number} of {len(found)}", exact=True).wait_for()
        joints = [page.get_by_label(f"Joint {name} [°], as a number").input_value() for name in UR5E.joint_names]
        seen.append(tuple(map(float, joints)))
        assert np.abs(tip(watched) - place).max() < 1e-6
        page.get_by_role("button", name="Next posture").click()
    assert len(found) > 1 and len(set(seen)) == len(found) and seen[0] == seen[-1]
    nearest = np.abs(np.rad2deg(found.configurations)[:, None] - np.array(seen)).max(axis=2).min(axis=1)
    assert nearest.max() < 0.1


def test_a_limit_that_is_dragged_is_followed_in_larger_voxels_first(watched: Watched, client: ws.Client) -> None:
    """Of as many samples; then in those of the file, with the limit that was set last."""
    fine = 0.025
    done = client.submit(JOB | {"voxel_size_m": fine}).wait()
    asked: list[dict] = []
    watched.page.on("websocket", lambda socket: socket.on("framesent", lambda text: asked.append(json.loads(text))))
    opened(watched, f"/job/{done.id}")
    page = watched.page
    page.get_by_text("Change limits").click()
    slider = page.get_by_label("Upper limit of joint2 [°]", exact=True)
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    page.mouse.move(box["x"] + box["width"] - 8, box["y"] + box["height"] / 2)
    page.mouse.down()
    for share in (0.8, 0.7, 0.6, 0.5):
        page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
        page.wait_for_timeout(60)
    page.mouse.up()
    last = np.deg2rad(float(page.get_by_label("Upper limit of joint2 [°], as a number").input_value()))
    page.wait_for_timeout(600)  # a hand that rests
    page.locator("[data-live=done][data-volume]").wait_for()
    found = [each for each in asked if each["ask"] == "volume"]
    assert found[-1]["voxel_size_m"] == fine
    assert found[0]["voxel_size_m"] > 1.2 * fine and len(found) >= 2
    assert {each["samples"] for each in found} == {1 << 20}
    assert found[-1]["limits"]["joint2"][1] == pytest.approx(last, abs=1e-3)
    assert page.get_by_label("Show As it was changed", exact=True).is_checked()


def test_the_joints_ways_are_drawn_and_stepped_along_while_the_tip_stands(watched: Watched, client: ws.Client) -> None:
    """Of an arm with a joint to spare: orange where the self-motion of the posture goes, which ends with the pose."""
    redundant = client.submit(JOB | {"robot": {"library": "kuka_iiwa14"}}).wait().id
    opened(watched, f"/job/{redundant}")
    page = watched.page
    page.get_by_label("Show Volume").uncheck()

    def orange() -> int:
        red, green, blue = np.moveaxis(pixels(watched).astype(int), 2, 0)
        return int(((red > 180) & (abs(green - red / 2.3) < 30) & (blue < 60)).sum())

    assert orange() == 0
    place = tip(watched)
    page.get_by_role("button", name="Other postures").click()
    slider = page.get_by_label("Along the self-motion", exact=True)
    slider.wait_for()
    assert orange() > 50
    joint, seen = page.get_by_label("Joint joint3 [°], as a number"), set()
    slider.focus()
    page.keyboard.press("Home")
    for _ in range(5):
        page.keyboard.press("ArrowRight")
        settle(watched)
        seen.add(joint.input_value())
        assert np.abs(tip(watched) - place).max() < 1e-6
    assert len(seen) == 5
    page.get_by_role("button", name="Home").click()
    assert orange() == 0


def test_a_click_on_a_map_stands_the_robot_there(watched: Watched, client: ws.Client) -> None:
    over = {"x_m": [-0.6, 0.6, 0.3], "y_m": [-0.4, 0.4, 0.4], "yaw_deg": [0, 180, 90], "z_m": 0.2}
    job = {"analysis": "base_placement", "robot": {"library": "puma560"}, "over": over, "refine": False}
    done = client.submit(job | {"targets": [{"position_m": [0.3, 0.1, 0.8]}]}).wait()
    table, q, half = done.result().tables["placement_map"], [0.4, -0.5, 0.6, 0.3, 0.2, 0.1], 1.2
    hidden = dict.fromkeys(("robot:0", "axes", "scale_bar", "targets"), OFF)
    opened(watched, f"/job/{done.id}", camera=looking([0, 0, 0.2], half, along="z"), configurations=[q], layers=hidden)
    picture, box = pixels(watched), watched.page.locator(".stage-host").bounding_box()
    rows = np.arange(len(table)).reshape(4, 2)
    served = table["served"][rows]
    assert len(np.unique(served)) == 2
    for cell in np.ndindex(4, 2):  # painted on the floor, in the colours of what is served
        center = [-0.45 + 0.3 * cell[0], -0.2 + 0.4 * cell[1], 0.2]
        ((column, row),) = spots(watched, center, [0, 0, 0.2], half, along="z").astype(int)
        color = mpl.colormaps["viridis"](float(served[cell] - served.min()), bytes=True)[:3]
        assert np.abs(picture[row - int(box["y"]), column - int(box["x"])] - np.array(color, int)).max() <= 1, cell
    watched.page.get_by_label("Show puma560", exact=True).check()
    arm = ws.load_robot("puma560")
    from_base = np.linalg.inv(arm.chain.T_world_base) @ arm.forward_kinematics(q)[0]
    said = watched.page.locator("h3:has-text('Where the robot stands') + dl")
    for cell in ([3, 1], [0, 0]):
        row = 2 * cell[0] + cell[1]
        center = [-0.45 + 0.3 * cell[0], -0.2 + 0.4 * cell[1], 0.2]
        T = np.eye(4)
        T[:3, :3] = Rotation.from_euler("z", table["yaw_deg"][row], degrees=True).as_matrix()
        T[:3, 3] = center
        watched.page.mouse.click(*spots(watched, center, [0, 0, 0.2], half, along="z")[0])
        expected = (T @ from_base)[:3, 3]
        until(lambda expected=expected: np.abs(tip(watched) - expected).max() < 1e-9)
        until(lambda row=row: said.inner_text().split("\n")[:2] == ["served", str(table["served"][row])])


OFF = {"visible": False, "opacity": 1}


def test_sliders_of_a_mapping_tell_what_lies_inside(watched: Watched, client: ws.Client) -> None:
    """A cube of 0.2 m, mapped into a box of 1 x 0.8 x 0.6 m: green where it lies inside, red elsewhere."""
    unit = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    job = {"analysis": "master_slave_mapping", "master": {"points": (unit * [1.0, 0.8, 0.6]).tolist()}}
    job |= {"slave": {"points": (0.2 * unit).tolist()}, "scale": 2.0, "offsets_m": [[0.1, 0.0, 0.0]], "search": None}
    done = client.submit(job).wait()
    manifest = httpx2.get(f"{watched.url}/v1/jobs/{done.id}/view", timeout=60).json()
    others = [each["name"] for part in ("meshes", "points", "curves", "glyphs") for each in manifest[part]]
    master = {**OFF, "style": "surface", "channel": "", "threshold": None, "cut": [], "minus": ""}
    layers = dict.fromkeys(["axes", "scale_bar", *others], OFF)
    opened(watched, f"/job/{done.id}", camera=looking([0, 0, 0], 1.0), layers=layers, volumes={"master": master})
    page = watched.page

    def seen(*places: tuple[float, float]) -> list[str]:
        """Colours at x and z [m]."""
        picture, box = pixels(watched), page.locator(".stage-host").bounding_box()
        found = []
        for column, row in spots(watched, [(x, 0.0, z) for x, z in places], [0, 0, 0], 1.0):
            red, green, blue = picture[int(row - box["y"]), int(column - box["x"])]
            found.append("paper" if min(red, green, blue) > 240 else "green" if green > red else "red")
        return found

    def put(label: str, value: float) -> None:
        page.get_by_label(f"{label}, as a number").fill(str(value))
        page.get_by_label(f"{label}, as a number").press("Enter")

    # It stands from -0.1 to 0.3 along x, and from -0.2 to 0.2 along z.
    assert seen((-0.15, 0), (-0.05, 0), (0.25, 0), (0.35, 0), (0.1, 0.25)) == [
        "paper",
        "green",
        "green",
        "paper",
        "paper",
    ]
    put("Offset x [m]", 0.4)
    assert seen((0.15, 0), (0.25, 0), (0.45, 0), (0.56, 0), (0.65, 0)) == ["paper", "green", "green", "red", "paper"]
    put("Scale z", 4.0)
    assert seen((0.4, 0.25), (0.4, -0.25), (0.4, 0.36), (0.4, 0.45)) == ["green", "green", "red", "paper"]
    put("Scale x", 1.0)
    assert seen((0.25, 0), (0.35, 0), (0.45, 0), (0.56, 0)) == ["paper", "green", "green", "paper"]
    page.get_by_role("button", name="As in the result").click()
    assert seen((-0.05, 0), (0.25, 0), (0.35, 0), (0.1, 0.25)) == ["green", "green", "paper", "paper"]


def test_leaving_a_view_frees_its_process(watched: Watched, server: LocalServer, searched: str) -> None:
    def children() -> set[int]:
        return {each.pid for each in psutil.Process(server.process.pid).children(recursive=True)}

    before = children()
    opened(watched, f"/job/{searched}")
    clicked(watched)
    session = {pid for pid in children() - before if psutil.Process(pid).nice() == NICE}
    assert len(session) == 1
    watched.page.get_by_role("link", name="Jobs").click()
    until(lambda: not session & children(), 20.0)


def test_a_view_that_is_left_while_its_session_opens_keeps_none(watched: Watched, searched: str) -> None:
    sockets = []
    watched.page.on("websocket", lambda socket: sockets.append(socket))
    watched.page.add_init_script(
        "WebSocket = class extends WebSocket { constructor(...to) { super(...to); location.hash = '#/jobs'; } }"
    )
    limits = json.dumps({"limits": [{"joint2": [-1.0, 0.0]}]}).encode()
    deflate = zlib.compressobj(wbits=-15)
    view = urlsafe_b64encode(deflate.compress(limits) + deflate.flush()).decode().rstrip("=")
    watched.page.goto(f"{watched.url}/#/job/{searched}?view={view}")
    watched.page.locator(f"tr[data-job='{searched}']").wait_for()
    until(lambda: len(sockets) == 1 and sockets[0].is_closed(), 10.0)


def test_the_volumes_of_all_robots_follow_their_limits(watched: Watched, client: ws.Client) -> None:
    arms = [{"robot": {"library": "scara", "placement": {"position_m": [0.3 * k, 0, 0]}}} for k in range(3)]
    job = {"analysis": "shared_workspace", "robots": arms, "voxel_size_m": 0.2, "refined_volume": None}
    done = client.submit(job).wait()
    opened(watched, f"/job/{done.id}", limits=[{"joint1": [0.0, 1.0 + k]} for k in range(3)])
    for name in ("scara", "scara_2", "scara_3"):
        watched.page.get_by_label(f"Show {name}, as it was changed", exact=True).wait_for()
