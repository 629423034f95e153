"""The recipes for nginx and Caddy, run before a real server under a prefix."""

import re
import shutil
import socket
import subprocess
import time
from pathlib import Path

import httpx2
import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.conftest import free_port, wait_for_port
from tests.server.end_to_end.acceptance import LONG_SHARD_SAMPLES, PATIENCE_S, QUICK

RECIPES = Path(__file__).parents[3] / "deploy/proxy"
NGINX = """daemon off; master_process off; pid {folder}/pid; error_log {folder}/error.log;
events {{ worker_connections 512; }}
http {{
    access_log off; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
    {site}
}}
"""
HEAD = b"POST /lab/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("WSRENDER_TRUSTED_PROXIES", "127.0.0.1")
        environment.setenv("WSRENDER_SHARD_SAMPLES", str(LONG_SHARD_SAMPLES))
        environment.setenv("WSRENDER_READ_TIMEOUT_S", "2")
        with LocalServer(tmp_path_factory.mktemp("data")) as server:
            yield server


def site(name, server, port):
    """A recipe, with the test's ports, and seconds of patience where it has ten."""
    text = (RECIPES / name).read_text()
    for what, instead in (
        ("127.0.0.1:8000", server.url.removeprefix("http://")), ("10s", "1s"), ("60s", "2s"),
        (":80 {", f"http://127.0.0.1:{port} {{"),
        ("listen 80;", f"listen 127.0.0.1:{port};"),
    ):  # fmt: skip
        text = text.replace(what, instead)
    assert str(port) in text and server.url.rpartition(":")[2] in text
    return text


@pytest.fixture(scope="module", params=["nginx", "caddy"])
def base(request, server, tmp_path_factory):
    """Where the proxy shows the server."""
    program = shutil.which(request.param) or shutil.which(request.param, path="/usr/sbin")
    if program is None:
        pytest.skip(f"{request.param} is not installed: apt-get install nginx-light caddy")
    folder, port = tmp_path_factory.mktemp(request.param), free_port()
    if request.param == "nginx":
        (folder / "conf").write_text(NGINX.format(folder=folder, site=site("nginx.conf", server, port)))
        command = [program, "-p", folder, "-c", folder / "conf"]
    else:
        text = site("Caddyfile", server, port).replace("{\n", "{\n\tadmin off\n\tauto_https off\n", 1)
        (folder / "Caddyfile").write_text(text)
        command = [program, "run", "--adapter", "caddyfile", "--config", folder / "Caddyfile"]
    with (folder / "log").open("w") as log:
        home = {"HOME": str(folder), "PATH": "/usr/bin"}
        process = subprocess.Popen(command, stdout=log, stderr=log, env=home, cwd=folder)
    try:
        wait_for_port(port, process)
        yield f"http://127.0.0.1:{port}/lab"
    finally:
        process.terminate()
        process.wait(60)


@pytest.fixture(scope="module")
def job(base):
    """A job that has succeeded."""
    with ws.Client(base) as client:
        return client.submit(QUICK | {"labels": {"by": base}}).wait(timeout=PATIENCE_S).record


def test_addresses_keep_the_prefix(base, job):
    host = base.removesuffix("/lab")
    assert httpx2.get(host + job["links"]["self"], timeout=60).json()["state"] == "succeeded"
    made = httpx2.post(f"{base}/v1/jobs", json=QUICK, timeout=60)
    assert made.headers["location"].startswith("/lab/v1/jobs/")
    assert httpx2.get(host + made.headers["location"], timeout=60).status_code == 200
    for artifact in httpx2.get(host + job["links"]["artifacts"], timeout=60).json()["items"]:
        assert httpx2.head(host + artifact["href"], timeout=60).status_code == 200
    assert httpx2.get(f"{base}/openapi.json", timeout=60).json()["servers"] == [{"url": "/lab"}]
    for page in ("/docs", "/"):
        for file in re.findall(r'(?:href|src)="([^"#]+)"', httpx2.get(base + page, timeout=60).text):
            assert httpx2.get(f"{base}/{file}", timeout=60).status_code == 200, file
    assert httpx2.post(f"{base}/v1/jobs", json=QUICK, headers={"Origin": host}, timeout=60).status_code in (200, 202)
    foreign = {"Origin": "http://evil.example.org"}
    assert httpx2.post(f"{base}/v1/jobs", json=QUICK, headers=foreign, timeout=60).status_code == 403


def test_events_come_one_by_one(base):
    with ws.Client(base) as client:
        begun = client.submit(QUICK | {"sampling": {"method": "sobol", "count": 10**10}, "labels": {"by": base}})
        times = []
        for event in begun.events():
            times.append(time.monotonic())
            if event["data"].get("fraction") and times[-1] - times[0] > 4:  # longer than bodies may take
                break
        begun.cancel()
    assert len(times) >= 3


def test_ranges_and_etags(base, job):
    path = f"{base.removesuffix('/lab')}{job['links']['artifacts']}/volume.vtkhdf"
    whole = httpx2.get(path, timeout=60)
    part = httpx2.get(path, headers={"Range": "bytes=100-199"}, timeout=60)
    assert (part.status_code, part.content) == (206, whole.content[100:200])
    assert httpx2.get(path, headers={"If-None-Match": whole.headers["etag"]}, timeout=60).status_code == 304
    large = httpx2.post(
        f"{base}/v1/models", content=b" " * (64 * 2**20 + 1), headers={"Content-Type": "application/xml"}
    )
    assert large.status_code == 413 and large.headers["content-type"] == "application/problem+json"


def test_forces(base):
    with ws.Client(base) as client, client.kinetostatic_stream("phantom_omni") as stream:
        for _ in range(20):
            message = stream.exchange([0.8, 0.9, -0.8, 0, 1.5, 0], timeout_s=60)
    assert message is not None


@pytest.mark.parametrize("data", [HEAD, HEAD + b"Content-Length: 99\r\n\r\n{"], ids=["head", "body"])
def test_half_requests_end(base, data):
    with socket.create_connection(("127.0.0.1", int(base.split(":")[2].partition("/")[0])), timeout=60) as client:
        client.sendall(data)
        said = client.recv(1 << 16)
    assert said == b"" or re.match(rb"HTTP/1.1 (408|504) ", said)


def test_a_refusal_waits_for_the_body(server):
    """Caddy breaks off an answer, six in 3,000, that comes while it still sends the body on."""
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=60) as client:
        client.sendall(HEAD + b"Origin: http://evil.example.org\r\nContent-Length: 2\r\n\r\n{")
        client.settimeout(0.5)
        with pytest.raises(TimeoutError):
            client.recv(1)
        client.settimeout(60)
        client.sendall(b"}")
        assert client.recv(1 << 16).startswith(b"HTTP/1.1 403 ")
