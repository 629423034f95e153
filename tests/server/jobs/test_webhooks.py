"""Webhooks: where they may go, how they are signed, and that each message comes at least once."""

import asyncio
import json
import socket
import ssl
import threading
import time
from contextlib import closing
from datetime import UTC, datetime, timedelta
from ipaddress import ip_network

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from sqlalchemy import select, update
from standardwebhooks import Webhook as Verifier
from standardwebhooks import WebhookVerificationError
from wsrender_server.jobs.faults import InvalidTransition, QuotaExceeded
from wsrender_server.jobs.records import DeliveryOutcome, DeliveryRecord, JobState
from wsrender_server.jobs.tables import Delivery
from wsrender_server.jobs.webhooks import store as webhook_store
from wsrender_server.jobs.webhooks.deliveries import AT_ONCE, LONGEST_WAIT_S, Deliveries, _next
from wsrender_server.jobs.webhooks.sender import LONGEST_SAID, Sender
from wsrender_server.jobs.webhooks.signature import new_secret
from wsrender_server.jobs.webhooks.targets import AllowedTargets
from wsrender_server.settings import Settings

from tests.server.http.idle_server import IdleJobs
from tests.server.jobs.receiver import receiver
from tests.server.jobs.waiting import wait_until
from wsrender.errors import InputError


def allowing(url, **others):
    """Settings that allow webhooks to go to a receiver of this machine."""
    return Settings(webhook_targets=url, webhook_networks="127.0.0.1", webhook_retry_s=0.05, **others)


def message(url, secret=None):
    return DeliveryRecord("msg_1", "webhook", url, secret or new_secret(), '{"type": "webhook.test"}')


def sent(settings, one, tls=None):
    """What came of sending a message once."""

    async def send():
        async with Sender(settings, tls) as sender:
            return await sender.send(one)

    return asyncio.run(send())


@pytest.fixture
def resolved(monkeypatch):
    """``resolved[name]`` are the addresses that each look-up of a name finds, the last again and again."""
    answers, ask = {}, socket.getaddrinfo

    def look_up(host, port, *arguments, **options):
        if host not in answers:
            return ask(host, port, *arguments, **options)
        found = answers[host].pop(0) if len(answers[host]) > 1 else answers[host][0]
        return [entry for each in found for entry in ask(each, port, type=socket.SOCK_STREAM)]

    monkeypatch.setattr(socket, "getaddrinfo", look_up)
    return answers


@pytest.mark.parametrize(
    ("url", "allowed"),
    [
        ("https://hooks.example.org/a?b=c", True), ("https://hooks.example.org:443/", True),
        ("https://HOOKS.example.org", True), ("https://a.lab.org:8443/x", True), ("https://a.b.lab.org:8443/x", True),
        ("http://receiver:9000", True), ("http://[2001:4860:4860::8888]/", True),
        ("http://hooks.example.org", False), ("https://hooks.example.org:8443", False), ("https://lab.org:8443", False),
        ("https://evillab.org:8443", False),
        ("https://hooks.example.org.evil.net", False), ("https://receiver:9000", False),
        ("http://receiver", False), ("http://[2001:4860:4860::8844]/", False),
    ],
)  # fmt: skip
def test_only_origins_of_the_settings_are_asked(url, allowed):
    origins = "https://hooks.example.org,https://*.lab.org:8443,http://receiver:9000,http://[2001:4860:4860::8888]"
    settings = Settings(webhook_targets=origins)
    targets = AllowedTargets(settings.webhook_targets, settings.webhook_networks)
    if allowed:
        targets.check(url)
        return
    with pytest.raises(InputError, match="must be of an origin that WSRENDER_WEBHOOK_TARGETS names") as refused:
        targets.check(url)
    assert refused.value.field == "url"


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("ftp://a.org", "must begin with https://"), ("file:///etc/passwd", "must begin with https://"),
        ("//a.org", "must begin with https://"), ("https://", "must begin with https://"), ("", "must begin with"),
        ("https://user@a.org", "neither a user"), ("https://user:word@a.org", "neither a user"),
        ("https://a.org/#b", "nor a fragment"), ("https://a.org/#", "nor a fragment"),
        ("https://a.org/\r\nX: y", "printable ASCII"), ("https://ä.org", "printable ASCII"),
        ("https://a.org/ b", "printable ASCII"), ("https://a.org:99999", "port between"),
        ("https://a.org:0", "port between"), ("https://[::1", "must be a URL"),
        ("https://a.org:x", "must be a URL"), ("https://a.org/" + "x" * 2048, "at most 2048 characters"),
    ],
)  # fmt: skip
def test_what_is_no_address_is_refused(url, said):
    with pytest.raises(InputError, match=said) as refused:
        AllowedTargets(("https://*", "http://*"), ()).check(url)
    assert refused.value.field == "url"


def test_by_default_nothing_is_asked():
    settings = Settings()
    with pytest.raises(InputError, match="nothing: this server sends no webhooks"):
        AllowedTargets(settings.webhook_targets, settings.webhook_networks).check("https://a.org")


@pytest.mark.parametrize("target", ["*", "https://", "a.org", "ftp://a.org", "https://a.org/path", "https://a*.org"])
def test_settings_name_origins(target):
    with pytest.raises(ValueError, match="must be origins"):
        Settings(webhook_targets=target)


NOT_PUBLIC = [
    "127.0.0.1", "127.8.9.1", "0.0.0.0", "10.1.2.3", "172.16.0.1", "192.168.1.1", "169.254.169.254", "100.64.0.1",
    "192.0.0.1", "198.18.0.1", "224.0.0.1", "240.0.0.1", "255.255.255.255", "::1", "::", "fe80::1", "fc00::1",
    "fec0::1", "ff02::1", "::ffff:127.0.0.1", "::ffff:10.0.0.1", "::ffff:169.254.169.254", "2002:7f00:1::",
    "64:ff9b:1::1", "2001:db8::1", "fd12::1",
]  # fmt: skip


@pytest.mark.parametrize("address", NOT_PUBLIC)
def test_no_address_that_is_not_public_is_asked(address, resolved):
    host = f"[{address}]" if ":" in address else address
    with pytest.raises(InputError, match="not public"):
        AllowedTargets(("https://*",), ()).check(f"https://{host}/")
    for found in ([address], ["93.184.216.34", address], [address, "93.184.216.34"]):
        resolved["inside.example.org"] = [found]
        outcome = sent(Settings(webhook_targets="https://*"), message("https://inside.example.org/"))
        assert not outcome.delivered and "inside.example.org has an address that is not public" in outcome.said


@pytest.mark.parametrize("host", ["localhost", "2130706433", "0x7f.1", "127.1", "0177.0.0.1"])
def test_other_ways_to_write_this_machine_are_no_way_in(host):
    with receiver() as here:
        port = here.url.rpartition(":")[2]
        settings = Settings(webhook_targets=f"http://*:{port}")
        outcome = sent(settings, message(f"http://{host}:{port}/"))
        assert not outcome.delivered and not here.got


def test_networks_of_the_settings_are_asked():
    targets = AllowedTargets(("https://*",), (ip_network("10.0.0.0/8"), ip_network("fd00::/8")))
    for address in ("10.1.2.3", "[fd12::1]", "[::ffff:10.1.2.3]", "93.184.216.34", "[2606:2800:220:1::1]"):
        targets.check(f"https://{address}/")
    with pytest.raises(InputError, match="not public"):
        targets.check("https://192.168.0.1")


def test_a_name_is_looked_up_once_and_the_connection_goes_there(resolved):
    """DNS rebinding: the second answer of a name server is never asked for."""
    with receiver() as here:
        port = int(here.url.rpartition(":")[2])
        with receiver(address="127.0.0.2", port=port) as inside:
            for _ in range(3):
                answers = resolved["rebound.example.org"] = [["127.0.0.1"], ["127.0.0.2"]]
                url = f"http://rebound.example.org:{port}/hook"
                outcome = sent(allowing(f"http://rebound.example.org:{port}"), message(url))
                assert outcome.delivered and answers == [["127.0.0.2"]]
            assert len(here.got) == 3 and not inside.got
    assert {headers["host"] for headers, _ in here.got} == {f"rebound.example.org:{port}"}


def test_the_next_address_of_a_name_is_asked_where_one_does_not_answer(resolved):
    """Each at most once: a message that may have arrived is not sent to another."""
    with receiver() as here:
        port = int(here.url.rpartition(":")[2])
        settings, one = allowing(f"http://hooks.example.org:{port}"), message(f"http://hooks.example.org:{port}/")
        settings = settings.model_copy(update={"webhook_networks": (ip_network("127.0.0.0/8"),)})
        resolved["hooks.example.org"] = [["127.0.0.2", "127.0.0.1"]]
        assert sent(settings, one).delivered and len(here.got) == 1
        resolved["hooks.example.org"] = [["127.0.0.2", "127.0.0.3"]]
        outcome = sent(settings, one)
        assert not outcome.delivered and "no answer" in outcome.said
    with receiver(lambda: 500, port=port) as first, receiver(address="127.0.0.2", port=port) as second:
        resolved["hooks.example.org"] = [["127.0.0.1", "127.0.0.2"]]
        assert not sent(settings, one).delivered and len(first.got) == 1 and not second.got


def test_redirects_are_not_followed_and_410_is_the_end():
    for status in (301, 302, 303, 307, 308, 400, 404, 410, 429, 500, 503):
        with receiver(lambda status=status: status) as here:
            outcome = sent(allowing(here.url), message(here.url))
            assert not outcome.delivered and f"answered {status}" in outcome.said
            assert ("redirects are not followed" in outcome.said) == (300 <= status < 400)
            assert outcome.gone == (status == 410) and len(here.got) == 1


def test_proxies_of_the_environment_are_not_asked(monkeypatch):
    with receiver() as proxy, receiver() as here:
        for name in ("http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"):
            monkeypatch.setenv(name, proxy.url)
        assert sent(allowing(here.url), message(here.url)).delivered
        assert here.got and not proxy.got


def test_answers_are_bounded_in_time_and_size(monkeypatch):
    """A receiver that says nothing, one that ends no head, and one that ends no body."""
    monkeypatch.setattr("wsrender_server.jobs.webhooks.sender.ATTEMPT_S", 1.0)
    endless = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n"
    for beginning, again, delivered in (
        (b"", b"", False), (b"HTTP/1.1 200 OK\r\n", b"X: " + b"y" * 9000 + b"\r\n", False),
        (b"HTTP/1.1 100 Continue\r\n\r\n", b"HTTP/1.1 100 Continue\r\n\r\n", False),
        (b"no HTTP\r\n\r\n", b"", False), (endless, b"1000\r\n" + b"z" * 4096 + b"\r\n", True),
    ):  # fmt: skip
        listener = socket.create_server(("127.0.0.1", 0))
        thread = threading.Thread(target=_pour, args=(listener, beginning, again), daemon=True)
        thread.start()
        url, began = f"http://127.0.0.1:{listener.getsockname()[1]}", time.monotonic()
        outcome = sent(allowing(url), message(url))
        assert outcome.delivered == delivered and len(outcome.said) <= LONGEST_SAID
        assert time.monotonic() - began < 30  # machines are shared
        listener.close()
        thread.join(30)
        assert not thread.is_alive()


def _pour(listener, beginning, again):
    """Answer one request with so much and more of it, until the other side has had enough."""
    connection, _ = listener.accept()
    with closing(connection):
        connection.settimeout(20)
        try:
            connection.recv(65536)
            connection.sendall(beginning)
            while again:
                connection.sendall(again)
            while connection.recv(65536):
                pass
        except OSError:
            pass


def test_the_certificate_is_that_of_the_name(resolved, tmp_path):
    serving, trusting = _certificate(tmp_path, "hooks.example.org")
    with receiver(tls=serving) as here:
        port = here.url.rpartition(":")[2]
        for host, delivered in (("hooks.example.org", True), ("other.example.org", False), ("127.0.0.1", False)):
            resolved[host] = [["127.0.0.1"]]
            settings = allowing(f"https://{host}:{port}")
            outcome = sent(settings, message(f"https://{host}:{port}/"), trusting)
            assert outcome.delivered == delivered, outcome
            assert not sent(settings, message(f"https://{host}:{port}/")).delivered  # the system trusts it not
        assert len(here.got) == 1


def _certificate(folder, name):
    """Contexts of a server with a certificate of a name, and of a client that trusts it."""
    key, subject = ec.generate_private_key(ec.SECP256R1()), x509.Name([])
    now = datetime.now(UTC)
    built = x509.CertificateBuilder(subject, subject, key.public_key(), x509.random_serial_number())
    built = built.not_valid_before(now - timedelta(days=1)).not_valid_after(now + timedelta(days=1))
    built = built.add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=True)
    file = folder / "certificate.pem"
    private = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    file.write_bytes(private + built.sign(key, hashes.SHA256()).public_bytes(serialization.Encoding.PEM))
    serving = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    serving.load_cert_chain(file)
    return serving, ssl.create_default_context(cafile=file)


def test_messages_are_verified_by_the_library():
    secret = new_secret()
    with receiver() as here:
        assert sent(allowing(here.url), message(here.url, secret)).delivered
        ((headers, body),) = here.got
    assert Verifier(secret).verify(body, headers) == {"type": "webhook.test"}
    assert headers["content-type"] == "application/json" and headers["user-agent"].startswith("wsrender/")
    for wrong in (
        (Verifier(new_secret()), body, headers),
        (Verifier(secret), body.replace(b"test", b"tess"), headers),
        (Verifier(secret), body, headers | {"webhook-id": "msg_2"}),
        (Verifier(secret), body, headers | {"webhook-timestamp": str(int(headers["webhook-timestamp"]) + 1)}),
    ):
        with pytest.raises(WebhookVerificationError):
            wrong[0].verify(wrong[1], wrong[2])


def due(store, later_s=0.0):
    return store.due_deliveries(datetime.now(UTC) + timedelta(seconds=later_s), LONGEST_WAIT_S)


def settle(store, outcomes, wait_s=0.0, give_up_s=3600.0):
    too_old = datetime.now(UTC) - timedelta(seconds=give_up_s)
    store.settle_deliveries(outcomes, dict.fromkeys(outcomes, wait_s), too_old)


def test_states_are_told_to_webhooks_that_ask_for_them(store, document):
    everything, _ = store.create_webhook("ann", "https://a.org/all", list(JobState))
    ends, secret = store.create_webhook("ann", "https://a.org/ends", ["failed", "succeeded", "failed"])
    store.create_webhook("bob", "https://b.org", list(JobState))
    assert ends.states == ("failed", "succeeded") and secret.startswith("whsec_")
    job = store.submit("ann", document, labels={"study": "wrist"}).job
    IdleJobs(store).fail(job.id, {"code": "not_converged", "message": "x" * 5000, "retryable": True, "secret": "/etc"})
    told = [(each.webhook, json.loads(each.body)) for each in due(store)]
    assert [body["type"] for webhook, body in told if webhook == ends.id] == ["job.failed"]
    bodies = sorted((body for webhook, body in told if webhook == everything.id), key=lambda body: body["timestamp"])
    assert [body["type"] for body in bodies] == ["job.queued", "job.running", "job.failed"]
    assert len(told) == 4 and len({each.id for each in due(store)}) == 4
    assert bodies[-1]["data"] == {
        "id": job.id, "analysis": "workspace", "state": "failed", "attempt": 1, "labels": {"study": "wrist"},
        "event": store.get("ann", job.id).last_event,
        "error": {"code": "not_converged", "detail": "x" * 1000, "retryable": True},
    }  # fmt: skip
    assert store.webhook("ann", everything.id).waiting == 3 and store.webhook("bob", everything.id) is None
    assert not store.delete_webhook("bob", everything.id) and store.delete_webhook("ann", everything.id)
    assert [each.webhook for each in due(store)] == [ends.id] and store.waiting_deliveries() == 1


def test_what_fails_waits_and_is_given_up_after_a_time(store):
    webhook, _ = store.create_webhook("ann", "https://a.org", ["failed"])
    store.test_webhook("ann", webhook.id)
    (one,) = due(store)
    settle(store, {one: DeliveryOutcome(False, "the receiver answered 500")}, wait_s=60)
    assert not due(store) and due(store, 61)[0].attempts == 1
    record = store.webhook("ann", webhook.id)
    assert (record.waiting, record.delivered, record.given_up) == (1, 0, 0)
    assert record.last_error == "the receiver answered 500" and record.last_error_at
    (one,) = due(store, 61)
    settle(store, {one: DeliveryOutcome(False, "the receiver answered 503")}, give_up_s=0)
    record = store.webhook("ann", webhook.id)
    assert (record.waiting, record.delivered, record.given_up) == (0, 0, 1) and not due(store, 1e6)
    message_id = store.test_webhook("ann", webhook.id)
    (one,) = due(store)
    assert one.id == message_id
    settle(store, {one: DeliveryOutcome(True, "the receiver answered 204")})
    record = store.webhook("ann", webhook.id)
    assert (record.waiting, record.delivered, record.given_up) == (0, 1, 1) and record.last_delivered_at
    assert store.deliveries == {"failed": 2, "given_up": 1, "delivered": 1}


def test_a_receiver_that_is_gone_gets_nothing_any_more(store, document):
    webhook, _ = store.create_webhook("ann", "https://a.org", list(JobState))
    for _ in range(3):
        store.test_webhook("ann", webhook.id)
    one = due(store)[0]
    settle(store, {one: DeliveryOutcome(False, "the receiver answered 410", gone=True)})
    assert store.webhook("ann", webhook.id).disabled_at and not due(store)
    store.submit("ann", document)
    store.prune_deliveries()
    assert store.waiting_deliveries() == 0
    with pytest.raises(InvalidTransition, match="disabled"):
        store.test_webhook("ann", webhook.id)


def test_deliveries_of_a_deleted_webhook_are_settled_as_nothing(store):
    webhook, _ = store.create_webhook("ann", "https://a.org", ["failed"])
    store.test_webhook("ann", webhook.id)
    (one,) = due(store)
    store.delete_webhook("ann", webhook.id)
    settle(store, {one: DeliveryOutcome(False, "the receiver answered 500")})
    assert not due(store, 1e6) and store.waiting_deliveries() == 0


def test_owners_have_so_many_webhooks_and_webhooks_so_many_messages(store, monkeypatch):
    webhooks = [store.create_webhook("ann", "https://a.org", ["failed"])[0] for _ in range(webhook_store.MOST_OF_OWNER)]
    with pytest.raises(QuotaExceeded, match="8 webhooks are allowed"):
        store.create_webhook("ann", "https://a.org", ["failed"])
    assert [each.id for each in store.list_webhooks("ann")] == [each.id for each in webhooks]
    store.create_webhook("bob", "https://b.org", ["failed"])
    for states in ([], ["odd"]):
        with pytest.raises((InputError, ValueError)):
            store.create_webhook("bob", "https://b.org", states)
    monkeypatch.setattr(webhook_store, "MOST_WAITING", 3)
    ids = [store.test_webhook("ann", webhooks[0].id) for _ in range(5)]
    store.test_webhook("ann", webhooks[1].id)
    store.prune_deliveries()
    kept = {each.id for each in due(store) if each.webhook == webhooks[0].id}
    record = store.webhook("ann", webhooks[0].id)
    assert kept == set(ids[2:]) and (record.waiting, record.given_up) == (3, 2)
    assert "more than 3 messages waited" in record.last_error
    assert store.webhook("ann", webhooks[1].id).waiting == 1


def test_nobody_waits_for_anothers_receiver(store):
    """Of each webhook a few are due at a time, first the first of each; of those, what has no place now waits."""
    busy, _ = store.create_webhook("ann", "https://a.org", ["failed"])
    calm, _ = store.create_webhook("bob", "https://b.org", ["failed"])
    for _ in range(20):
        store.test_webhook("ann", busy.id)
    store.test_webhook("bob", calm.id)
    found = due(store)
    assert [each.webhook for each in found].count(busy.id) == 4 and calm.id in {each.webhook for each in found[:2]}
    assert list(_next(found, {})) == found
    at_work = dict(enumerate(found[:3]))
    assert [each.id for each in _next(found, at_work)] == [each.id for each in found[3:]]
    many = [DeliveryRecord(f"msg_{k}", f"webhook{k}", "", "", "") for k in range(AT_ONCE + 5)]
    assert list(_next(many, {})) == many[:AT_ONCE]


def test_a_clock_that_was_set_back_holds_nothing_up(store):
    webhook, _ = store.create_webhook("ann", "https://a.org", ["failed"])
    store.test_webhook("ann", webhook.id)
    with store.transactions.write() as session:
        session.execute(update(Delivery).values(next_at=datetime.now(UTC) + timedelta(days=300)))
    assert len(due(store)) == 1


def test_a_revoked_key_is_told_nothing(store, document):
    key, _ = store.create_key("ann")
    webhook, _ = store.create_webhook(key.id, "https://a.org", list(JobState))
    store.submit(key.id, document)
    assert due(store)
    store.revoke_key(key.id)
    store.prune_deliveries()
    assert not due(store) and store.webhook(key.id, webhook.id) is None and store.waiting_deliveries() == 0


def test_waits_double_up_to_an_hour_and_are_random(store):
    deliveries = Deliveries(store, Settings(webhook_retry_s=5))
    for attempts, longest in ((0, 5), (1, 10), (5, 160), (10, 3600), (10_000, 3600)):
        waits = [deliveries.wait_s(attempts) for _ in range(200)]
        assert longest / 2 <= min(waits) < 0.6 * longest < 0.9 * longest < max(waits) <= longest


def test_a_clock_that_jumps_ahead_gives_nothing_up(store, monkeypatch):
    deliveries, now, settled = Deliveries(store, Settings()), datetime.now(UTC), []

    class Ahead(datetime):
        @classmethod
        def now(cls, tz=None):
            return now + timedelta(days=300)

    monkeypatch.setattr("wsrender_server.jobs.clock.datetime", Ahead)
    monkeypatch.setattr(store, "settle_deliveries", lambda outcomes, waits, too_old: settled.append(too_old))

    async def settle():
        attempt = asyncio.create_task(asyncio.sleep(0, "an outcome"))
        await deliveries._settle({attempt: message("http://lab")}, 1.0, asyncio.ALL_COMPLETED)

    asyncio.run(settle())
    assert settled[0] < now + timedelta(hours=1) - timedelta(seconds=Settings().webhook_give_up_s)


def test_deliveries_go_on_after_failures_and_a_restart(store, document):
    answers = iter([500, 302, 200])
    with receiver(lambda: next(answers, 200)) as here:
        webhook, secret = store.create_webhook("ann", here.url, ["queued"])
        store.submit("ann", document)
        with Deliveries(store, allowing(here.url)).running():
            wait_until(lambda: len(here.got) >= 1)
        failed = store.webhook("ann", webhook.id)
        assert failed.delivered == 0 or len(here.got) >= 3
        with Deliveries(store, allowing(here.url)).running():
            wait_until(lambda: store.webhook("ann", webhook.id).delivered == 1)
            time.sleep(0.6)  # longer than between two looks: it does not come again
    assert len({headers["webhook-id"] for headers, _ in here.got}) == 1 and len(here.got) == 3
    assert all(Verifier(secret).verify(body, headers)["type"] == "job.queued" for headers, body in here.got)
    assert len({body for _, body in here.got}) == 1


def test_what_is_delivered_while_the_server_stops_is_recorded(store, monkeypatch):
    """It does not come again."""
    for name, seconds in (("LOOK_S", 0.05), ("LAST_S", 20.0)):  # machines are shared
        monkeypatch.setattr(f"wsrender_server.jobs.webhooks.deliveries.{name}", seconds)
    going, done = threading.Event(), threading.Event()

    def slowly():
        going.set()
        assert done.wait(30)
        return 204

    with receiver(slowly) as here:
        webhook, _ = store.create_webhook("ann", here.url, ["queued"])
        store.test_webhook("ann", webhook.id)
        with Deliveries(store, allowing(here.url)).running():
            assert going.wait(30)
            threading.Timer(1.0, done.set).start()  # when it has long stopped to look for more
        record = store.webhook("ann", webhook.id)
        assert (record.delivered, record.waiting, len(here.got)) == (1, 0, 1)


def test_what_nobody_is_to_get_goes_while_deliveries_run(store, monkeypatch):
    monkeypatch.setattr(webhook_store, "MOST_WAITING", 3)
    with receiver(lambda: 500) as here:
        webhook, _ = store.create_webhook("ann", here.url, ["queued"])
        for _ in range(9):
            store.test_webhook("ann", webhook.id)
        with Deliveries(store, allowing(here.url)).running():
            wait_until(lambda: store.webhook("ann", webhook.id).given_up == 6)


def test_a_fault_of_the_store_ends_nothing(store, document, monkeypatch):
    monkeypatch.setattr("wsrender_server.jobs.webhooks.deliveries.AFTER_FAULT_S", 0.05)
    faults, ask = iter([OSError("gone"), ValueError("odd")]), store.due_deliveries

    def asked(*arguments):
        if fault := next(faults, None):
            raise fault
        return ask(*arguments)

    monkeypatch.setattr(store, "due_deliveries", asked)
    with receiver() as here:
        store.create_webhook("ann", here.url, ["queued"])
        store.submit("ann", document)
        with Deliveries(store, allowing(here.url)).running():
            wait_until(lambda: here.got)


def test_a_message_that_cannot_be_sent_holds_up_no_other(store):
    with receiver() as here:
        webhook, _ = store.create_webhook("ann", here.url, ["queued"])
        store.test_webhook("ann", webhook.id)
        broken, _ = store.create_webhook("ann", here.url, ["queued"])
        store.test_webhook("ann", broken.id)
        with store.transactions.write() as session:
            row = session.scalar(select(webhook_store.Webhook).where(webhook_store.Webhook.id == broken.id))
            row.secret = "whsec_é"
        with Deliveries(store, allowing(here.url)).running():
            wait_until(
                lambda: store.webhook("ann", webhook.id).delivered and store.webhook("ann", broken.id).last_error
            )
    assert store.webhook("ann", broken.id).delivered == 0
