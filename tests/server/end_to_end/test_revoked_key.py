"""A stream of events, and a request that waits, ends soon after its key was revoked, though its job has not ended."""

import time
from concurrent.futures import ThreadPoolExecutor

import httpx2
from wsrender_server.local_server import LocalServer

from tests.server.end_to_end.acceptance import PATIENCE_S, QUICK

SECRET = "an-administrators-secret-of-the-test"
SOON_S = 20.0  # a second is the rule; machines are shared


def bearer(secret):
    return {"Authorization": f"Bearer {secret}"}


def test_a_stream_ends_with_its_key(tmp_path):
    keys = tmp_path / "keys"
    keys.write_text(f"{SECRET} root admin\n")
    keys.chmod(0o600)
    with (
        LocalServer(tmp_path / "data", ["--api-key-file", str(keys)]) as server,
        httpx2.Client(base_url=server.url, timeout=PATIENCE_S) as http,
    ):
        ann, bob = (
            http.post("/v1/keys", json={"name": name}, headers=bearer(SECRET)).json() for name in ("ann", "bob")
        )
        waiting = QUICK | {"sampling": {"method": "sobol", "count": 9_000_000_000}}  # it takes hours
        jobs = [http.post("/v1/jobs", json=waiting, headers=bearer(key["secret"])).json() for key in (ann, bob)]
        streams = [
            http.stream("GET", f"/v1/jobs/{job['id']}/events", headers=bearer(key["secret"]))
            for job, key in zip(jobs, (ann, bob), strict=True)
        ]
        path = f"/v1/jobs/{jobs[0]['id']}?wait=60"
        waits = [("GET", path, None), ("GET", f"{path}&after=1000000", None), ("POST", "/v1/jobs?wait=60", waiting)]
        with streams[0] as of_ann, streams[1] as of_bob, ThreadPoolExecutor(len(waits)) as pool:
            assert of_ann.status_code == of_bob.status_code == 200
            lines = of_ann.iter_lines()
            assert next(lines)  # it has begun
            answers = [
                pool.submit(http.request, method, at, json=body, headers=bearer(ann["secret"]))
                for method, at, body in waits
            ]
            time.sleep(2)  # all of them wait
            assert not any(answer.done() for answer in answers)
            began = time.monotonic()
            revoked = http.post(f"/v1/keys/{ann['id']}:revoke", headers=bearer(SECRET))
            assert revoked.json()["revoked_at"]
            for line in lines:
                assert time.monotonic() - began < SOON_S and "failed" not in line, line
            assert time.monotonic() - began < SOON_S
            assert next(of_bob.iter_lines())
            assert [answer.result(PATIENCE_S).status_code for answer in answers] == [401] * len(waits)
            assert time.monotonic() - began < SOON_S
        job = http.get(f"/v1/jobs/{jobs[1]['id']}", headers=bearer(bob["secret"])).json()
        assert job["state"] in ("queued", "running")
        assert http.get(f"/v1/jobs/{jobs[0]['id']}", headers=bearer(ann["secret"])).status_code == 401
