"""Names that the server answers to, pages that may ask it, and the prefix of a proxy, on every route."""

import platform

import pytest
from fastapi.routing import APIRoute
from fastapi.testclient import TestClient
from starlette.requests import HTTPConnection
from wsrender_server.app import ROUTERS, create_app
from wsrender_server.hosts import check_names
from wsrender_server.problems import HttpProblem
from wsrender_server.settings import Settings

from tests.server.http.idle_server import DOCUMENT, HOST, problem_of
from wsrender.errors import InputError

STATIC = [("GET", path) for path in ("/", "/docs", "/openapi.json", "/viewer/viewer.js", "/nothing")]
ROUTES = [
    (method, route.path_format.format_map(dict.fromkeys(route.param_convertors, "x")))
    for router in ROUTERS
    for route in router.routes
    if isinstance(route, APIRoute)
    for method in route.methods
] + STATIC


@pytest.fixture
def asked(settings, jobs):
    """``asked(settings…)`` is a client of a server with these settings."""
    return lambda **more: TestClient(create_app(Settings(**settings.model_dump() | more), jobs), base_url=HOST)


def test_an_address_may_have_a_zone():
    """As of a machine on the same cable; its colon and brackets are no reason to ask who is meant."""
    for host in ("[fe80::1%eth0]:8000", "[fe80::1%25eth0]", "[fe80::1%25Eth0.1]:80"):
        headers = {"host": host, "origin": f"http://{host}"}
        scope = {"type": "http", "headers": [(name.encode(), value.encode()) for name, value in headers.items()]}
        check_names(HTTPConnection(scope), Settings())
        scope["headers"][1] = (b"origin", b"http://[fe80::2%25eth0]")
        with pytest.raises(HttpProblem, match="may not ask"):
            check_names(HTTPConnection(scope), Settings())
    for host in ("[fe80::1%]", "[fe80::1%a b]", "[fe80::1%eth0", "fe80::1%eth0", "[%eth0]x"):
        with pytest.raises(HttpProblem, match="does not know"):
            check_names(HTTPConnection({"type": "http", "headers": [(b"host", host.encode())]}), Settings())


def test_every_route_refuses_names_and_pages_of_others(client):
    for method, path in ROUTES:
        for headers, code in (
            ({"Host": "rebound.example.org"}, "wrong_host"),
            ({"Host": "rebound.example.org", "Origin": "http://rebound.example.org"}, "wrong_host"),
            ({"Host": ""}, "wrong_host"), ({"Origin": "https://evil.example.org"}, "wrong_origin"),
            ({"Origin": "null"}, "wrong_origin"), ({"Origin": "http://127.0.0.1.evil.example.org"}, "wrong_origin"),
        ):  # fmt: skip
            answer = client.request(method, path, headers=headers)
            assert answer.status_code == 403, (method, path, headers)
            if method != "HEAD":
                problem_of(answer, 403, code)


def test_a_page_of_another_site_cancels_nothing(client, submit):
    path = submit()["links"]["self"]
    problem_of(client.post(f"{path}:cancel", headers={"Origin": "http://evil.example.org"}), 403, "wrong_origin")
    assert client.get(path).json()["state"] == "queued"
    own = {"Origin": "http://127.0.0.1:5173"}  # ports of this machine are its user's
    assert client.post(f"{path}:cancel", headers=own).json()["state"] == "canceled"


def test_names_in_a_network_of_ones_own_need_no_setting(asked, jobs):
    secret = jobs.store.create_key("ann")[1]
    key = {"Authorization": f"Bearer {secret}"}
    names = ["lab", "lab:8000", "lab.local", "192.168.1.2", "[fe80::1]:8000", "10.0.0.7:8000", "LAB", platform.node()]
    with asked() as client:
        for name in names:
            assert client.get("/v1/jobs", headers=key | {"Host": name}).status_code == 200, name
            assert client.get("/v1/jobs", headers=key | {"Host": name, "Origin": f"http://{name}"}).status_code == 200
        problem = problem_of(client.get("/v1/jobs", headers=key | {"Host": "lab.example.org"}), 403, "wrong_host")
        assert "WSRENDER_ALLOWED_HOSTS" in problem["detail"]


def test_other_names_are_a_setting(asked, monkeypatch):
    monkeypatch.setenv("WSRENDER_ALLOWED_HOSTS", "Lab.example.org, pages.example.org")
    assert Settings().allowed_hosts == ("lab.example.org", "pages.example.org")
    with asked(allowed_hosts=("lab.example.org", "pages.example.org")) as client:
        for headers in ({"Host": "lab.example.org:443"}, {"Origin": "https://pages.example.org"}):
            assert client.get("/v1/jobs", headers=headers).status_code == 200  # without a key, too: it is said
        problem_of(client.get("/v1/jobs", headers={"Host": "other.example.org"}), 403, "wrong_host")
        problem_of(client.get("/v1/jobs", headers={"Host": "lab"}), 403, "wrong_host")


def paths_of(client, headers, result_folder, jobs):
    """Every address that answers hold: of jobs, artifacts and models."""
    made = client.post("/v1/jobs", json=DOCUMENT, headers=headers)
    job = made.json()
    jobs.complete(job["id"], result_folder)
    artifacts = client.get(f"/v1/jobs/{job['id']}/artifacts", headers=headers).json()["items"]
    xml = {"Content-Type": "application/xml"}
    model = client.post("/v1/models", content="<mujoco/>", headers=headers | xml)
    models = client.get("/v1/models", headers=headers).json()["items"]
    listed = client.get("/v1/jobs", headers=headers).json()["items"][0]["links"]
    return [
        made.headers["location"], *job["links"].values(), *listed.values(), *(each["href"] for each in artifacts),
        model.headers["location"], model.json()["href"], *(each["href"] for each in models),
    ]  # fmt: skip


def test_addresses_begin_with_the_prefix_of_the_settings(asked, jobs, result_folder):
    with asked(root_path="/lab/ws") as client:
        for path in paths_of(client, {}, result_folder, jobs):
            assert path.startswith("/lab/ws/v1/")
            assert client.get(path).status_code == 200  # of a proxy that leaves the prefix in place
            assert client.get(path.removeprefix("/lab/ws")).status_code == 200
        assert client.get("/openapi.json").json()["servers"] == [{"url": "/lab/ws"}]
        assert "url: 'openapi.json'" in client.get("/docs").text
    for wrong in ("lab", "/lab/", "/la b", "//evil.example.org"):
        with pytest.raises(ValueError, match="root_path"):
            Settings(root_path=wrong)


@pytest.mark.parametrize(("proxies", "trusted"), [((), False), (("10.0.0.0/8",), False), (("127.0.0.1",), True)])
def test_a_prefix_is_taken_from_trusted_proxies_only(settings, jobs, result_folder, proxies, trusted):
    app = create_app(Settings(**settings.model_dump() | {"trusted_proxies": proxies}), jobs)
    with TestClient(app, base_url=HOST, client=("127.0.0.1", 1)) as client:
        begins = "/lab/v1/" if trusted else "/v1/"
        for path in paths_of(client, {"X-Forwarded-Prefix": "/lab/"}, result_folder, jobs):
            assert path.startswith(begins)
        for odd in ("//evil.example.org", "https://evil.example.org", "/a\tb", "/lab/..%2f"):
            assert client.get("/v1/jobs", headers={"X-Forwarded-Prefix": odd}).text.count(odd) == 0
        assert "servers" not in client.get("/openapi.json").json()


def test_what_is_no_proxy_is_refused(monkeypatch):
    monkeypatch.setenv("WSRENDER_TRUSTED_PROXIES", "127.0.0.1, 10.1.0.0/16")
    assert Settings().trusts("10.1.2.3") and not Settings().trusts("10.2.0.1") and not Settings().trusts("testclient")
    from wsrender_server.commands import settings_of

    monkeypatch.setenv("WSRENDER_TRUSTED_PROXIES", "the proxy")
    with pytest.raises(InputError, match="trusted_proxies"):
        settings_of()


OTHER = "https://lab.example.org"


def test_pages_of_named_origins_ask_and_read(asked, jobs, result_folder):
    """As a browser does: the question whether it may, then the request; answers name what scripts may read."""
    with asked(cors_origins=(OTHER, "http://localhost:3000")) as client:
        wanted = {
            "Access-Control-Request-Method": "POST",
            "Access-Control-Request-Headers": "authorization,content-type",
        }
        may = client.options("/v1/jobs", headers={"Origin": OTHER} | wanted)
        assert may.status_code == 200 and may.headers["Access-Control-Allow-Origin"] == OTHER
        assert "POST" in may.headers["Access-Control-Allow-Methods"]
        assert {"authorization", "idempotency-key"} <= set(
            may.headers["Access-Control-Allow-Headers"].lower().split(", ")
        )
        assert "Access-Control-Allow-Credentials" not in may.headers
        made = client.post("/v1/jobs", json=DOCUMENT, headers={"Origin": OTHER})
        assert made.status_code == 202 and made.headers["Access-Control-Allow-Origin"] == OTHER
        jobs.complete(made.json()["id"], result_folder)
        plane = client.get(f"/v1/jobs/{made.json()['id']}/volume/slice", headers={"Origin": "http://localhost:3000"})
        exposed = set(plane.headers["Access-Control-Expose-Headers"].lower().split(", "))
        own = {name for name in plane.headers if name.startswith("x-") and name != "x-content-type-options"}
        assert plane.status_code == 200 and own | {"location", "etag"} <= exposed
        for other in ("https://evil.example.org", f"{OTHER}:444", OTHER.replace("https", "http"), f"{OTHER}.evil.org"):
            refused = client.options("/v1/jobs", headers={"Origin": other} | wanted)
            assert refused.status_code == 403 and "Access-Control-Allow-Origin" not in refused.headers
            problem_of(client.post("/v1/jobs", json=DOCUMENT, headers={"Origin": other}), 403, "wrong_origin")


def test_origins_are_checked(monkeypatch):
    monkeypatch.setenv("WSRENDER_CORS_ORIGINS", f"{OTHER.upper()}, http://[::1]:3000")
    assert Settings().cors_origins == (OTHER, "http://[::1]:3000")
    for wrong in ("*", "lab.example.org", f"{OTHER}/", "ftp://lab", "null", f"{OTHER}, *"):
        with pytest.raises(ValueError, match="must be origins"):
            Settings(cors_origins=wrong)


def test_without_a_setting_no_page_of_another_site_reads(client):
    answer = client.get("/v1/version", headers={"Origin": "http://127.0.0.1:5173"})
    assert answer.status_code == 200 and not [name for name in answer.headers if name.startswith("access-control")]
