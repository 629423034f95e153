"""What keeps a server from running here is said, with the command that mends it."""

import importlib.metadata
import json
import socket
import sqlite3
import subprocess
from contextlib import closing

import pytest
from wsrender_server import doctor
from wsrender_server.auth import read_key_file
from wsrender_server.settings import Settings

from tests.server.conftest import free_port
from wsrender import cli


@pytest.fixture
def settings(tmp_path):
    """Settings of a server that can run here."""
    return Settings(data_dir=tmp_path / "data", port=free_port(), min_free_disk_bytes=0)


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as ended:
        cli.main([*arguments])
    return ended.value.code, capsys.readouterr().out


def wrong(check, settings):
    """The finding of a check that finds something wrong."""
    (finding,) = check(settings)
    assert finding.remedy
    return finding.found, finding.remedy


def test_where_nothing_is_wrong_everything_is_told_and_nothing_made(tmp_path, capsys):
    code, text = run(capsys, "doctor", "--json", "--data-dir", str(tmp_path / "data"), "--port", str(free_port()))
    found = json.loads(text)
    names = ["versions", "gpu", "opengl", "permissions", "store", "database", "port", "scheduler"]
    assert [each["check"] for each in found] == names
    assert code == (not all(each["ok"] for each in found)) and not (tmp_path / "data").exists()
    for each in found:
        assert each["ok"] == (not each["remedy"]) and each["found"] and "\n" not in each["found"]
        assert each["ok"] or each["check"] == "opengl", each


def test_what_is_wrong_is_an_exit_code_and_a_command(tmp_path, capsys, monkeypatch):
    (tmp_path / "data").mkdir()
    (tmp_path / "data").chmod(0o755)
    monkeypatch.setattr(doctor, "_run", lambda program: ("", "|"))
    code, text = run(capsys, "doctor", "--data-dir", str(tmp_path / "data"), "--port", "0")
    assert code == 1 and f"wrong  permissions: other users may look into {tmp_path}/data\n         chmod go= " in text


def test_a_taken_port(settings):
    with socket.create_server(("127.0.0.1", settings.port)):
        found, remedy = wrong(doctor._port, settings)
    assert "Address already in use" in found and str(settings.port) in remedy


def test_a_scheduler_that_is_not_there(settings, tmp_path):
    files = {f"tls_{name}_file": tmp_path / name for name in ("ca", "cert", "key")}
    cluster = Settings(**settings.model_dump() | files | {"scheduler": f"tls://127.0.0.1:{free_port()}"})
    assert "nobody listens at tls://127.0.0.1" in wrong(doctor._scheduler, cluster)[0]
    found, remedy = wrong(doctor._permissions, cluster)
    assert found == f"{tmp_path}/ca is not there" and remedy.startswith(f"deploy/certificates.sh {tmp_path}  # ")
    for path in files.values():
        path.touch()
        path.chmod(0o644)
    assert wrong(doctor._permissions, cluster)[1] == f"chmod go= {tmp_path}/key"


def test_a_secret_that_is_read_by_its_group_is_right_where_we_are_of_it(settings, tmp_path, monkeypatch):
    """As Kubernetes mounts one: root's, 0440, the pod's processes another user's of that group."""
    keys = tmp_path / "keys"
    keys.write_text("a-secret-of-many-characters\n")
    keys.chmod(0o440)
    asked = Settings(**settings.model_dump() | {"api_key_file": keys})
    assert wrong(doctor._permissions, asked)[1] == f"chmod go= {keys}"  # our own file: nobody else need read it
    monkeypatch.setattr(doctor.os, "geteuid", lambda: keys.stat().st_uid + 1)
    monkeypatch.setattr(doctor.os, "getgroups", lambda: [keys.stat().st_gid])
    assert "is writable" in next(doctor._permissions(asked)).found
    keys.chmod(0o444)
    assert "other users" in wrong(doctor._permissions, asked)[0]
    keys.chmod(0o460)
    assert "other users" in wrong(doctor._permissions, asked)[0]
    keys.chmod(0o440)
    monkeypatch.setattr(doctor.os, "getgroups", list)
    monkeypatch.setattr(doctor.os, "getegid", lambda: keys.stat().st_gid + 1)
    assert "other users" in wrong(doctor._permissions, asked)[0]


def test_databases(settings, tmp_path):
    assert "is made at the first start" in next(doctor._database(settings)).found
    settings.data_dir.mkdir()
    with closing(sqlite3.connect(settings.data_dir / "wsrender.db")) as file:
        file.execute("CREATE TABLE x (y)")
    found, remedy = wrong(doctor._database, settings)
    assert remedy == f"wsrender database upgrade --data-dir {settings.data_dir}"
    with closing(sqlite3.connect(settings.data_dir / "wsrender.db")) as file:
        file.executescript("CREATE TABLE alembic_version (version_num); INSERT INTO alembic_version VALUES ('9999');")
    assert wrong(doctor._database, settings)[1].startswith("wsrender database restore")
    gone = Settings(database="postgresql+psycopg://me:secret@127.0.0.1:1/x", data_dir=settings.data_dir)
    found, remedy = wrong(doctor._database, gone)
    assert "does not answer" in found and remedy == "pg_isready -h 127.0.0.1 -p 1" and "secret" not in found


def test_a_full_disk(settings):
    full = settings.model_copy(update={"min_free_disk_bytes": 2**60})
    remedy = wrong(doctor._store, full)[1]
    assert f"wsrender database prune --data-dir {settings.data_dir}" in remedy


def test_files_that_cannot_be_read(settings, tmp_path, monkeypatch):
    """Each remedy is typed, and then nothing is wrong any more."""
    asked = Settings(**settings.model_dump() | {"api_key_file": tmp_path / "keys"})
    found, remedy = wrong(doctor._permissions, asked)
    assert found == f"{tmp_path}/keys is not there"
    subprocess.run(remedy, shell=True, check=True)
    assert "is writable" in next(doctor._permissions(asked)).found and len(read_key_file(tmp_path / "keys")) == 1
    (tmp_path / "keys").chmod(0)
    monkeypatch.setattr(doctor.os, "access", lambda path, rights: bool(path.stat().st_mode & 0o400))  # for root, too
    found, remedy = wrong(doctor._permissions, asked)
    assert found == f"{tmp_path}/keys cannot be read"
    subprocess.run(remedy, shell=True, check=True)
    assert "is writable" in next(doctor._permissions(asked)).found


def test_packages_and_devices(settings, monkeypatch):
    version = importlib.metadata.version
    for name, given in (("dask", "2020.1"), ("mujoco", None)):
        with monkeypatch.context() as patch:

            def version_of(package, name=name, given=given):
                if package == name and given is None:
                    raise importlib.metadata.PackageNotFoundError(package)
                return given if package == name else version(package)

            patch.setattr(importlib.metadata, "version", version_of)
            found, remedy = wrong(doctor._versions, settings)
            assert found == f"{name} {given or 'is missing'}" and remedy.startswith(f'pip install "{name}')
    monkeypatch.setattr(doctor, "present_gpus", lambda: ["0", "1"])
    monkeypatch.setattr(doctor, "_run", lambda program: ("", "Warp\n|NVIDIA H100"))
    assert wrong(doctor._gpu, settings)[0] == "of 2 GPUs Warp sees 1"
    monkeypatch.setattr(doctor, "_run", lambda program: ("ImportError: libGL.so.1", ""))
    assert "libGL.so.1" in wrong(doctor._opengl, settings)[0] and "libGL.so.1" in wrong(doctor._gpu, settings)[0]


def test_settings_are_listed_with_their_source(capsys, monkeypatch):
    monkeypatch.setenv("WSRENDER_PORT", "8123")
    monkeypatch.setenv("WSRENDER_DATABASE", "postgresql+psycopg://me:secret@db/x")
    code, text = run(capsys, "settings", "--json")
    rows = {row["variable"]: row for row in json.loads(text)}
    assert code == 0 and [*rows] == [f"WSRENDER_{name.upper()}" for name in Settings.model_fields]
    assert (rows["WSRENDER_PORT"]["value"], rows["WSRENDER_PORT"]["source"]) == (8123, "environment")
    assert (rows["WSRENDER_HOST"]["value"], rows["WSRENDER_HOST"]["source"]) == ("127.0.0.1", "default")
    assert all(row["meaning"] for row in rows.values())
    assert rows["WSRENDER_DATABASE"]["value"] == "postgresql+psycopg://me:***@db/x"
    code, text = run(capsys, "settings")
    assert "WSRENDER_PORT=8123  (environment)\n    Port to listen on" in text and "secret" not in text
