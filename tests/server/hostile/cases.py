"""What strangers may send: requests that each must be refused, or be harmless, whatever they aim at."""

import gzip
import io
import json
import struct
import warnings
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.robots.test_malformed import BOMB, MJCF, URDF, XML

JSON = {"Content-Type": "application/json"}
VALIDATE, FILE = "/v1/jobs:validate", {"Content-Type": "model/stl"}
REFUSED = frozenset({400, 404, 405, 409, 411, 413, 415, 422, 429, 431})
HARMLESS = REFUSED | {200, 201, 202}
DOCUMENT = {
    "analysis": "workspace",
    "robot": {"library": "scara"},
    "sampling": {"method": "grid", "per_joint": 4},
    "voxel_size_m": 0.05,
    "device": "cpu",
}


@dataclass(frozen=True)
class Case:
    """A request; ``upload`` goes first, and its hash stands for SHA256 in the body.

    ``pointer`` begins the pointer of the field that the problem must name; None: it names none, or need not.
    """

    name: str
    body: bytes = b""
    pointer: str | None = None
    allowed: frozenset[int] = REFUSED
    method: str = "POST"
    path: str = VALIDATE
    headers: dict[str, str] = field(default_factory=lambda: dict(JSON))
    upload: bytes | None = None


def document(name: str, pointer: str | None, upload: bytes | None = None, allowed=REFUSED, **fields: Any) -> Case:
    """A job with other fields."""
    body = json.dumps(DOCUMENT | fields).encode("utf-8", "surrogatepass")
    return Case(name, body, pointer, allowed, upload=upload)


def texts() -> Iterator[Case]:
    """Robots in texts that are no models, hostile, or more than is supported."""
    for kind, found in (("mjcf", {**XML, **MJCF}), ("urdf", {**XML, **URDF})):
        for name, (text, _) in found.items():
            if isinstance(text, bytes):
                yield Case(f"{kind}: {name}, uploaded", text, None, method="POST", path="/v1/models", headers=XML_BODY)
            elif not ("surrogate" in name and kind == "urdf") and len(text) < 2**23:
                no_json = "surrogate" in name  # which has no fields
                yield document(f"{kind}: {name}", None if no_json else "#/robot", robot={kind: text})


XML_BODY = {"Content-Type": "application/xml"}
ARM = '<joint name="j" range="-1 1"/><geom size=".1"/><site name="tool" pos="1 0 0"/>'


def mjcf(body: str = "", more: str = "", before: str = "") -> str:
    return f"{before}<mujoco>{more}<worldbody><body>{ARM}{body}</body></worldbody></mujoco>"


def urdf(mesh: str) -> str:
    shape = f'<collision><geometry><mesh filename="{mesh}"/></geometry></collision>'
    joint = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    return f'<robot name="r"><link name="a"/><link name="b">{shape}</link>{joint}{limit}</robot>'


def files(secret: str) -> Iterator[Case]:
    """Whatever could make a server open the file ``secret``, or lead to it."""
    inside = {"include": f'<include file="{secret}"/>', "attached model": '<attach model="m" prefix="p"/>'}
    assets = {
        "model asset": f'<asset><model name="m" file="{secret}"/></asset>',
        "mesh": f'<asset><mesh name="m" file="{secret}"/></asset>',
        "mesh directory": f'<compiler meshdir="{secret}"/><asset><mesh name="m" file="x.stl"/></asset>',
        "asset directory": f'<compiler assetdir="{secret}/.."/><asset><mesh name="m" file="x.stl"/></asset>',
        "texture": f'<asset><texture name="t" type="2d" file="{secret}"/><material name="k" texture="t"/></asset>',
        "cube texture": f'<asset><texture name="t" type="cube" fileright="{secret}"/></asset>',
        "height field": f'<asset><hfield name="h" file="{secret}" size="1 1 1 1"/></asset>',
        "skin": f'<asset><skin name="s" file="{secret}"/></asset>',
        "plugin": '<extension><plugin plugin="mujoco.sdf.bolt"><instance name="b"/></plugin></extension>',
        "flex": f'<worldbody><flexcomp name="f" type="gmsh" file="{secret}"/></worldbody>',
        "keyframes of a file": f'<keyframe><key file="{secret}"/></keyframe>',
    }
    used = '<geom type="mesh" mesh="m"/>'
    for name, text in inside.items():
        yield document(f"{name} in a body", "#/robot", robot={"mjcf": mjcf(text)})
    for name, text in assets.items():
        allowed = REFUSED if name in ("model asset", "flex") else HARMLESS
        shape = used if "mesh" in text else '<geom type="hfield" hfield="h"/>' if "hfield" in text else ""
        yield document(name, None, robot={"mjcf": mjcf(shape, text)}, allowed=allowed)
        guarded = {"robot": {"mjcf": mjcf(shape, text)}, "constraints": {"self_collision": True}}
        yield document(f"{name} that may collide", None, allowed=allowed, **guarded)
        yield document(f"{name} of a scene", "#/environment/items/0" if allowed == REFUSED else None, allowed=allowed,
                       environment={"items": [{"shape": "scene", "mjcf": mjcf(shape, text)}]})  # fmt: skip
    entity = f'<!DOCTYPE m [<!ENTITY x SYSTEM "file://{secret}">]>'
    for name, before in {
        "entity": entity, "parameter entity": f'<!DOCTYPE m [<!ENTITY % x SYSTEM "file://{secret}"> %x;]>',
        "document type": f'<!DOCTYPE mujoco SYSTEM "{secret}">', "public type": f'<!DOCTYPE m PUBLIC "a" "{secret}">',
        "notation": f'<!DOCTYPE m [<!NOTATION n SYSTEM "{secret}">]>',
        "bomb": f'<!DOCTYPE m [<!ENTITY e0 "ha">{BOMB}]>',
    }.items():  # fmt: skip
        for kind, text in (("mjcf", mjcf(before=before)), ("urdf", before + urdf("a.stl"))):
            yield document(f"{name} in {kind}", f"#/robot/{kind}", robot={kind: text})
            yield Case(f"{name} in uploaded {kind}", text.encode(), "#", path="/v1/models", headers=XML_BODY)
    xinclude = f'<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="{secret}" parse="text"/>'
    yield document("XInclude", "#/robot", robot={"mjcf": mjcf(xinclude)})
    for mesh in (secret, f"file://{secret}", f"package://x/../../..{secret}", f"model:/{secret}",
                 f"../../../..{secret}", f"http://127.0.0.1:1{secret}", f"\\\\127.0.0.1{secret}"):  # fmt: skip
        yield document(f"URDF mesh {mesh.partition(secret)[0]!r}", None, robot={"urdf": urdf(mesh)}, allowed=HARMLESS,
                       constraints={"self_collision": True})  # fmt: skip
    item = "#/environment/items/0"
    paths = {
        "robot": ({"robot": {"path": secret}}, "#/robot/path"),
        "library": ({"robot": {"library": f"../../../..{secret}"}}, "#/robot/library"),
        "model": ({"robot": {"model": f"../../../..{secret}"}}, "#/robot/model"),
        "mesh item": ({"environment": {"items": [{"shape": "mesh", "path": secret}]}}, f"{item}/path"),
        "scene item": ({"environment": {"items": [{"shape": "scene", "path": secret}]}}, f"{item}/path"),
        "robot item": ({"environment": {"items": [{"robot": {"path": secret}, "configuration": [0]}]}}, item),
        "height field item": ({"environment": {"items": [{"shape": "height_field", "path": secret}]}}, item),
        "tool": ({"robot": {"library": "scara", "tool_shapes": [{"shape": "mesh", "path": secret}]}}, "#/robot"),
        "targets": ({"analysis": "reachability", "targets": {"path": secret}}, "#/"),
        "points": ({"analysis": "collaborative_volume", "left": {"path": secret}}, "#/"),
        "checkpoint": ({"checkpoint": secret}, "#/checkpoint"),
        "output": ({"output": secret}, "#/output"),
    }
    for name, (fields, pointer) in paths.items():
        yield document(f"path of {name}", pointer, **fields)
    for path in (secret, f"..{secret}", f"%2e%2e{secret}", "..%2f" * 9 + secret[1:], "..%5c" * 9 + secret[1:]):
        for route in ("/docs/files/", "/viewer/", "/v1/models/", "/v1/robots/", f"/v1/jobs/{'0' * 32}/artifacts/"):
            yield Case(f"GET {route} {path.replace(secret, '')}", method="GET", path=route + path.lstrip("/"))


def values() -> Iterator[Case]:
    """Every field of a job with values of other kinds, sizes and depths."""
    odd = {
        "list": [], "null": None, "text": "x" * 5000, "zero byte": "a\0b", "deep": [[[[[[[[[[1]]]]]]]]]],
        "objects": [{"a": {}}] * 100, "half a character": "\ud800", "whole numbers": list(range(3000)),
    }  # fmt: skip
    for name in ("analysis", "robot", "sampling", "voxel_size_m", "device", "constraints", "environment", "indices"):
        for kind, value in odd.items():
            nothing = value is None and name in ("constraints", "environment", "indices", "voxel_size_m")
            allowed = HARMLESS if nothing or (name, kind) == ("indices", "list") else REFUSED
            yield document(f"{name}: {kind}", None if allowed == HARMLESS or "half" in kind else f"#/{name}",
                           allowed=allowed, **{name: value})  # fmt: skip


def numbers() -> Iterator[Case]:
    """Every number of a job where it is none, or none that can be meant."""
    places = {
        "voxel_size_m": '"voxel_size_m": {}', "sampling.per_joint": '"sampling": {{"method": "grid", "per_joint": {}}}',
        "sampling.count": '"sampling": {{"method": "sobol", "count": {}}}', "max_samples": '"max_samples": {}',
        "sampling.seed": '"sampling": {{"method": "random", "count": 9, "seed": {}}}', "timeout_s": '"timeout_s": {}',
        "refined_volume": '"refined_volume": {}',
        "robot.length_unit_m": '"robot": {{"library": "scara", "length_unit_m": {}}}',
        "robot.limits": '"robot": {{"library": "scara", "limits": {{"joint1": [0, {}]}}}}',
    }  # fmt: skip
    wrong = ("-1", "1e999", "-1e999", "9" * 5000, '"1"', "true", "NaN", "Infinity", "[1]", "1e308")
    for place, text in places.items():
        for value in wrong:
            fields = {name: each for name, each in DOCUMENT.items() if name != place.partition(".")[0]}
            body = json.dumps(fields)[:-1] + ", " + text.format(value) + "}"
            pointer = None if value in ("NaN", "Infinity") or len(value) > 100 else "#/" + place.partition(".")[0]
            fine = (place, value) in FINE
            yield Case(f"{place}: {value[:9]}", body.encode(), None if fine else pointer, HARMLESS if fine else REFUSED)


# Numbers that may be meant: an enormous voxel, an early deadline, a joint that turns far.
FINE = {("timeout_s", "1e308"), ("voxel_size_m", "1e308"), ("robot.limits", "-1"), ("max_samples", "1e308")}


def bodies() -> Iterator[Case]:
    """Bodies that are no JSON, too deep, too many, or something else."""
    text = json.dumps(DOCUMENT)
    raw = {
        "nothing": b"", "blank": b"   ", "half": text[:40].encode(), "two": (text * 2).encode(), "zero": b"\0" * 100,
        "UTF-16": text.encode("utf-16"), "latin-1": b'{"analysis": "\xe9"}', "deep lists": b"[" * 10**6,
        "deep objects": b'{"a":' * 10**6, "deep and closed": b"[" * 5000 + b"]" * 5000, "a number": b"1" * 10**6,
        "a thousand keys": json.dumps(DOCUMENT | {f"k{k}": k for k in range(1000)}).encode(), "keys twice":
        b'{"analysis": "workspace", "analysis": "workspace"}', "a long key": json.dumps({"k" * 10**6: 1}).encode(),
        "prototype": b'{"__proto__": {"analysis": "workspace"}}', "YAML": b"analysis: workspace", "XML": b"<a/>",
        "pickle": b"cos\nsystem\n(S'true'\ntR.", "compressed": gzip.compress(text.encode()), "many zeros": b"0" * 10**6,
        "too large": b" " * (2**24 + 1), "comments": ("/* */" + text).encode(), "one text": b'"' + b"a" * 10**6 + b'"',
    }  # fmt: skip
    for name, content in raw.items():
        yield Case(f"body: {name}", content)
    rows = {
        "rows of nothing": [[]] * 200_000, "wrong rows": [[0, 0, 0, "x"]] * 50_000, "long rows": [[0.0] * 100_000] * 5,
        "rows in rows": [[[[0]]]] * 100_000, "nulls": [None] * 500_000, "texts": ["x"] * 200_000,
    }  # fmt: skip
    for name, value in rows.items():
        body = {"analysis": "indices_at", "robot": "scara", "configurations": value}
        yield Case(f"rows: {name}", json.dumps(body).encode(), "#/configurations")
    for name, media in (
        ("none", ""),
        ("text", "text/plain"),
        ("form", "multipart/form-data; boundary=x"),
        ("a", "a/b"),
    ):
        yield Case(f"media type: {name}", text.encode(), headers={"Content-Type": media})
    for name, key in (("empty", ""), ("long", "k" * 300), ("control", "a\tb")):
        yield Case(f"idempotency key: {name}", text.encode(), path="/v1/jobs", headers=JSON | {"Idempotency-Key": key})


def archives(secret: str) -> Iterator[Case]:
    """ZIPs of models: refused when they arrive, and by the jobs that name them if they arrived as something else."""
    model, entity = mjcf().encode(), f'<!DOCTYPE m [<!ENTITY e0 "ha">{BOMB}]>'
    good = {"m.xml": model}
    packed = zipped(good)
    structure = {
        "no ZIP": b"PK\x03\x04" + b"\0" * 100,
        "cut short": packed[:-30],
        "empty": zipped({}),
        "no model": zipped({"a.stl": b"x"}),
        "a link": zipped_infos([("m.xml", model), (of_mode(0o120777), secret.encode())]),
        "a device": zipped_infos([("m.xml", model), (of_mode(0o020666), b"")]),
        "the name twice": zipped_infos([("m.xml", model), ("m.xml", b"<mujoco/>")]),
        "a name twice by a dot": zipped({**good, "./m.xml": b""}),
        "climbing": zipped({**good, "../../etc/cron.d/x": b"x"}),
        "climbing within": zipped({**good, "a/../../x.stl": b"x"}),
        "an absolute name": zipped({**good, secret: b"x"}),
        "a backslash": zipped({**good, "..\\x.stl": b"x"}),
        "a drive": zipped({**good, "C:x.stl": b"x"}),
        "a line in a name": zipped({**good, "a\nb.stl": b"x"}),
        "a long name": zipped({**good, "a" * 600: b"x"}),
        "encrypted": flagged(packed),
        "another method": zipped(good, zipfile.ZIP_LZMA),
        "many files": zipped({**good, **{f"{k}.stl": b"" for k in range(6000)}}),
        "unpacks to much": declaring(packed, 2**31),
    }
    numbered = {str(k): b"<a>" + b"<b/>" * 15_000 + b"</a>" for k in range(50)}
    used = mjcf('<geom type="mesh" mesh="m"/>', '<asset><mesh name="m" file="m.obj"/></asset>')
    inside: dict[str, dict[str, bytes]] = {
        "bomb of a mesh": {"m.xml": used.encode(), "m.obj": b"\0" * 10**8},
        "large model": {"m.xml": b" " * 10**8},
        "bomb of entities": {"m.xml": mjcf(before=entity).encode()},
        "includes itself": {"m.xml": b'<mujoco><include file="m.xml"/></mujoco>'},
        "a circle": {"m.xml": including("a/b"), "a/b": including("m.xml")},
        "includes the secret": {"m.xml": including(secret)},
        "includes what climbs": {"m.xml": including(f"../../../../..{secret}")},
        "deep by includes": {"m.xml": nested("0"), **{str(k): nested(str(k + 1)) for k in range(9)}, "9": b"<a/>"},
        "many elements by includes": {"m.xml": including(*numbered), **numbered},
        "USD": {"m.xml": b"PXR-USDC"},
        "xacro": {"m.urdf": b'<robot name="r"><xacro:include filename="/etc/passwd"/></robot>'},
        "package that climbs": {"m.urdf": urdf(f"package://x/../../..{secret}").encode(), "x/a.stl": b"x"},
        "two models": {"m.xml": model, "n.xml": model},
    }
    zips = structure | {name: zipped(files) for name, files in inside.items()} | {"damaged": damaged(packed)}
    for name, content in zips.items():
        if name in structure:
            yield Case(f"ZIP: {name}", content, "#", path="/v1/models", headers={"Content-Type": "application/zip"})
        yield document(f"ZIP of a job: {name}", "#/robot", content, robot={"model": "SHA256"},
                       constraints={"self_collision": True})  # fmt: skip
        yield document(f"ZIP of a scene: {name}", "#/environment/items/0", content,
                       environment={"items": [{"shape": "scene", "model": "SHA256"}]})  # fmt: skip
    yield document("ZIP without the entry", "#/robot/entry", packed, robot={"model": "SHA256", "entry": secret})


def including(*names: str) -> bytes:
    """A model that includes files."""
    return b"<mujoco>" + b"".join(f'<include file="{name}"/>'.encode() for name in names) + b"</mujoco>"


def nested(included: str) -> bytes:
    """A part of a model that includes another in many elements."""
    return b"<mujoco>" + b"<body>" * 50 + f'<include file="{included}"/>'.encode() + b"</body>" * 50 + b"</mujoco>"


def of_mode(mode: int) -> zipfile.ZipInfo:
    """An entry of a file of another kind, as Unix says it."""
    info = zipfile.ZipInfo("m.stl")
    info.create_system, info.external_attr = 3, mode << 16
    return info


def zipped_infos(files: list[tuple[Any, bytes]]) -> bytes:
    """A ZIP of files by their entries of the directory, twice by a name too."""
    file = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(file, "w") as archive:
        warnings.simplefilter("ignore", UserWarning)
        for info, content in files:
            archive.writestr(info, content)
    return file.getvalue()


def flagged(packed: bytes) -> bytes:
    """A ZIP whose one file says that it is encrypted."""
    found = bytearray(packed)
    found[found.index(b"PK\x01\x02") + 8] |= 1
    return bytes(found)


def declaring(packed: bytes, size: int) -> bytes:
    """A ZIP whose one file says that it unpacks to so many bytes."""
    at = packed.index(b"PK\x01\x02") + 24
    return packed[:at] + struct.pack("<I", size) + packed[at + 4 :]


def damaged(packed: bytes) -> bytes:
    """A ZIP whose one file is not what its checksum says."""
    at = packed.index(b"m.xml") + 5
    return packed[:at] + bytes(255 - each for each in packed[at : at + 40]) + packed[at + 40 :]


def uploads() -> Iterator[Case]:
    """Uploaded files that a job names as a mesh, heights or targets."""
    triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    header = b"\0" * 80
    ply = b"ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nelement face %d\nend_header\n"
    meshes = {
        "empty STL": header + struct.pack("<I", 0), "STL that says more": header + struct.pack("<I", 2**32 - 1),
        "STL cut short": header + struct.pack("<I", 3) + b"\0" * 99, "STL of NaN": header + struct.pack("<I", 4)
        + np.full((4, 12), np.nan, "<f4").tobytes() + b"\0" * 8, "STL text": b"solid a\nvertex 1 2\n",
        "endless solid": b"solid " + b"a" * 10**6, "OBJ of one point": b"v 0 0 0\nf 1 1 1", "OBJ of far indices":
        triangle + b"f 1 2 999999999999", "OBJ of negative indices": triangle + b"f -9 -8 -7", "OBJ of words":
        b"v a b c\nf x y z", "OBJ of NaN": b"v nan 0 0\n" + triangle + b"f 1 2 3", "OBJ of 1e999":
        b"v 1e999 0 0\nf 1 1 1",
        "OBJ with a material file": b"mtllib /etc/passwd\n" + triangle + b"f 1 2 3", "OBJ of a long line":
        triangle + b"f" + b" 1" * 10**6, "PLY of 10^9": ply % (10**9, 10**9), "PLY of -1": ply % (2**63, 1),
        "PLY alone": b"ply\n", "flat": triangle[:24] + b"f 1 2 3", "open": triangle + b"f 1 2 3\nf 1 2 4",
        "PNG": b"\x89PNG\r\n\x1a\n" + b"\0" * 100, "zip": zipped({"a.stl": b"\0" * 100}), "zip bomb":
        zipped({"a.obj": b"\0" * 10**8}), "gzip": gzip.compress(b"\0" * 10**7), "zip that climbs":
        zipped({"../../../etc/cron.d/x": b"* * * * * root true\n"}), "ELF": b"\x7fELF" + b"\0" * 100,
        "COLLADA with an entity": b"<!DOCTYPE a [<!ENTITY b SYSTEM '/etc/passwd'>]><COLLADA>&b;</COLLADA>",
        "glTF with a file": b'{"asset":{"version":"2.0"},"buffers":[{"uri":"/etc/passwd","byteLength":9}]}',
        "text": b"hello", "zeros": b"\0" * 10**6, "OFF of 10^9": b"OFF\n1000000000 1000000000 0\n",
    }  # fmt: skip
    for name, content in meshes.items():
        mesh, collides = {"shape": "mesh", "model": "SHA256"}, {"self_collision": True}
        yield document(f"mesh of surroundings: {name}", "#/environment/items/0", content, constraints=collides,
                       environment={"items": [mesh]})  # fmt: skip
        hull = name in ("OBJ of a long line", "OBJ with a material file", "open")  # of which a tool takes the hull
        yield document(f"mesh of a tool: {name}", None if hull else "#/robot", content, constraints=collides,
                       allowed=HARMLESS if hull else REFUSED,
                       robot={"library": "scara", "tool_shapes": [mesh]})  # fmt: skip
    npy = {
        "objects": numpy_bytes(np.array([{}], object)), "NaN": numpy_bytes(np.full((4, 4), np.nan)),
        "no file": b"\x93NUM",
        "5-d": numpy_bytes(np.zeros((2, 2, 2, 2, 2))), "texts": numpy_bytes(np.array([["a"]])), "empty":
        numpy_bytes(np.zeros((0, 3))), "10^12 rows": numpy_header("<f8", (10**12, 3)), "negative rows":
        numpy_header("<f8", (-1, 3)), "code": numpy_header("__import__('os').system('true')", (1,)), "npz bomb":
        zipped({"a.npy": numpy_header("<f8", (10**7,)) + b"\0" * 8 * 10**7}), "Parquet without an end":
        b"PAR1" + b"\0" * 99,
        "Parquet of nonsense": b"PAR1" + b"\xff" * 99 + struct.pack("<I", 2**31) + b"PAR1", "CSV of nothing": b"\n\n\n",
        "CSV of a wide row": b",".join([b"1"] * 10**6), "CSV of formulas": b"x_m,y_m,z_m\n=1+1,@x,1\n", "CSV of 1e999":
        b"x_m,y_m,z_m\n1e999,0,0\n", "CSV of one column": b"x\n1\n", "CSV of quotes": b'"' * 10**6,
    }  # fmt: skip
    for name, content in npy.items():
        heights = {"shape": "height_field", "model": "SHA256", "size_m": [1, 1]}
        yield document(f"heights: {name}", "#/environment/items/0", content, environment={"items": [heights]},
                       constraints={"self_collision": True})  # fmt: skip
        job = {"analysis": "reachability", "robot": "scara", "targets": {"model": "SHA256"}}
        yield Case(f"targets: {name}", json.dumps(job).encode(), "#/targets", upload=content)
        job = {"analysis": "indices_at", "robot": "scara", "configurations": {"model": "SHA256"}}
        yield Case(f"configurations: {name}", json.dumps(job).encode(), "#/configurations", upload=content)


def zipped(entries: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """A zip file."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as file:
        for name, content in entries.items():
            file.writestr(name, content)
    return buffer.getvalue()


def numpy_bytes(array: np.ndarray) -> bytes:
    """An NPY file."""
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=True)
    return buffer.getvalue()


def numpy_header(kind: str, shape: tuple[int, ...]) -> bytes:
    """The beginning of an NPY file that says what follows, and nothing that follows."""
    text = repr({"descr": kind, "fortran_order": False, "shape": shape}).encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text


def bombs() -> Iterator[Case]:
    """Small texts that would make something enormous, or slow."""
    ball = '<geom size=".1"/>'
    points = " ".join(f"{np.cos(k):.9f} {np.sin(k):.9f} {k % 2}" for k in range(20_000))
    made = {
        "replicas": mjcf(f'<replicate count="300"><replicate count="300">{ball}</replicate></replicate>'),
        "replicas with a sign": mjcf(f'<replicate count="+300"><replicate count="+300">{ball}</replicate></replicate>'),
        "replicas with a space": mjcf(f'<replicate count=" 300"><replicate count=" 99">{ball}</replicate></replicate>'),
        "replicas of nine digits": mjcf(f'<replicate count="999999999">{ball}</replicate>'),
        "replicas of names": mjcf(f'<replicate count="999"><geom size="1" name="{"a" * 99_999}"/></replicate>'),
        "a cone": mjcf('<geom type="mesh" mesh="m"/>', builtin("cone", "1000000000 1")),
        "a plate": mjcf('<geom type="mesh" mesh="m"/>', builtin("plate", "100000 100000")),
        "a sphere": mjcf('<geom type="mesh" mesh="m"/>', builtin("sphere", "30")),
        "a supersphere": mjcf('<geom type="mesh" mesh="m"/>', builtin("supersphere", "30000 1 1")),
        "many supertori": mjcf("", "".join(builtin("supertorus", "300 .5 1 1", f"m{k}") for k in range(99))),
        "an infinite cone": mjcf('<geom type="mesh" mesh="m"/>', builtin("cone", "1e999 1")),
        "composites": mjcf('<composite type="cable" count="999999 1 1"/>'),
        "flexible grids": mjcf('<flexcomp type="grid" count="999 999 999" name="f"/>'),
        "elements": "<mujoco>" + "<a/>" * 30_000 + "</mujoco>", "depth": "<mujoco>" + "<body>" * 5000,
    }  # fmt: skip
    harmless = {
        "user arrays": mjcf("", '<size nuser_body="100000000" nuser_geom="100000000"/>'),
        "activations": mjcf("", '<actuator><general joint="j" dyntype="user" actdim="500000000"/></actuator>'),
        "histories": mjcf("", '<actuator><motor joint="j" nsample="16777216" delay="1"/></actuator>' * 50),
        "memory": mjcf("", '<size memory="900G"/>'),
        "muscles": mjcf("", '<compiler><lengthrange mode="all" inttotal="1e9" interval="1" timestep="1e-6"/></compiler>'
                        '<actuator><muscle joint="j"/></actuator>'),
        "textures": mjcf("", '<asset><texture name="t" builtin="flat" width="99999" height="99999"/></asset>'),
        "heights": mjcf("", '<asset><hfield name="h" nrow="99999" ncol="99999" size="1 1 1 1"/></asset>'),
        "points on circles": mjcf('<geom type="mesh" mesh="m"/>', f'<asset><mesh name="m" vertex="{points}"/></asset>'),
    }  # fmt: skip
    for name, text in made.items():
        yield document(f"makes {name}", "#/robot", robot={"mjcf": text})
    for name, text in harmless.items():
        yield document(f"asks for {name}", None, robot={"mjcf": text}, allowed=HARMLESS)
    rows = [{"joint": "revolute", "a": 1.0}] * 5000
    yield document("makes 5000 joints", "#/robot", robot={"dh": {"rows": rows}})
    yield document("makes voxels", "#/voxel_size_m", voxel_size_m=1e-7)
    yield document("makes samples", "#/sampling", sampling={"method": "grid", "per_joint": 10**9})
    balls = [{"shape": "sphere", "radius_m": 0.1}] * 20_000
    yield document("makes 20,000 balls", "#/environment", environment={"items": balls})


def builtin(kind: str, params: str, name: str = "m") -> str:
    """A mesh that MuJoCo makes."""
    return f'<asset><mesh name="{name}" builtin="{kind}" params="{params}"/></asset>'


def others(job: str, model: str) -> Iterator[Case]:
    """What belongs to somebody else, asked for by its name, and rights that a key does not have."""
    routes = ["", "/events", "/result", "/artifacts", "/artifacts/result.json", "/volume/slice?axis=z", "/plots/robot",
              "/volume?format=npz", "/tables/sample", "/histogram",
              "/view", "/view/blobs/volume0", "/volume/voxel?x=0&y=0&z=0"]  # fmt: skip
    for route in routes:
        yield foreign(f"GET of another's job{route}", "GET", f"/v1/jobs/{job}{route}")
    for method, route in (("POST", ":cancel"), ("POST", ":retry"), ("DELETE", "")):
        yield foreign(f"{method} of another's job{route}", method, f"/v1/jobs/{job}{route}")
    yield foreign("another's model", "GET", f"/v1/models/{model}")
    places = {
        "#/robot/model": {"robot": {"model": model}},
        "#/environment/items/0/model": {"environment": {"items": [{"shape": "mesh", "model": model}]}},
        "#/environment/items/0/robot/model": {
            "environment": {"items": [{"robot": {"model": model}, "configuration": [0]}]}
        },
    }
    for pointer, fields in places.items():
        yield document(f"another's model at {pointer}", pointer, allowed=frozenset({404}), **fields)
    job_of_targets = {"analysis": "reachability", "robot": "scara", "targets": {"model": model}}
    yield Case("another's model as targets", json.dumps(job_of_targets).encode(), "#/targets", frozenset({404}))
    for method, route in (
        ("GET", "/v1/keys"),
        ("POST", "/v1/keys"),
        ("POST", "/v1/keys/abc:revoke"),
        ("GET", "/metrics"),
    ):
        body = b'{"name": "x", "scopes": ["admin"]}' if method == "POST" else b""
        allowed = frozenset({403}) if route != "/metrics" else frozenset({200, 403})
        yield Case(f"{method} {route} without the right", body, None, allowed, method, route)
    headers = {"none": "", "wrong": "Bearer wrong", "basic": "Basic YTpi", "long": "Bearer " + "a" * 5000,
               "control": "Bearer a\tb", "two": "Bearer a b"}  # fmt: skip
    for kind, header in headers.items():
        yield Case(f"key: {kind}", b"", None, frozenset({401}), "GET", f"/v1/jobs/{job}", {"Authorization": header})


def foreign(name: str, method: str, path: str) -> Case:
    """A request for what is another's: it is not there."""
    return Case(name, b"", None, frozenset({404}), method, path)
