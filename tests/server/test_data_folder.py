"""Where the server's data is by default, and that looking makes nothing."""

import os
from pathlib import Path

import pytest
from wsrender_server.jobs.files import DataFolder
from wsrender_server.settings import OLD_FOLDER, Settings, default_data_dir

from wsrender import cli
from wsrender.errors import InputError


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A user's home, and another working directory; both empty."""
    for name in ("home", "work"):
        (tmp_path / name).mkdir()
    for variable in ("XDG_DATA_HOME", "WSRENDER_DATA_DIR", "WSRENDER_DATABASE"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path / "home"


@pytest.fixture
def wsrender(capsys):
    """Run the command line: exit code, output, error."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.main([*arguments])
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run


def made(home):
    return sorted(str(path.relative_to(home.parent)) for path in home.parent.rglob("*")) != ["home", "work"]


def test_the_default_is_the_users_wherever_they_stand(home):
    assert Settings().data_dir == default_data_dir() == home / ".local/share/wsrender"
    assert not made(home)


def test_queries_make_nothing(home, wsrender):
    database = home / ".local/share/wsrender/wsrender.db"
    code, listed, said = wsrender("keys", "list")
    assert (code, said) == (0, f"there is no database at {database}, so there are no keys\n") and "created" in listed
    assert wsrender("keys", "revoke", "0" * 16) == (1, "", f"error: there is no key {'0' * 16} in {database}\n")
    assert not made(home)


def test_keys_are_made_and_found_from_anywhere(home, wsrender, monkeypatch):
    database = home / ".local/share/wsrender/wsrender.db"
    code, _, said = wsrender("keys", "create", "--name", "ann")
    assert code == 0 and f"servers on {database} ask for keys" in said and database.exists()
    monkeypatch.chdir(home)
    code, listed, said = wsrender("keys", "list")
    assert (code, said, "ann" in listed) == (0, "", True)
    assert not any((home.parent / "work").iterdir())


def test_listing_keys_makes_no_folders_beside_a_database(home, wsrender, tmp_path):
    url = f"sqlite:///{tmp_path}/elsewhere/keys.db"
    assert wsrender("database", "upgrade", "--database", url)[0] == 0
    code, listed, _ = wsrender("keys", "list", "--database", url)
    assert code == 0 and "created" in listed and not (home / ".local").exists()


@pytest.mark.filterwarnings("default")
def test_the_folder_of_earlier_versions_is_found_with_a_warning(home, wsrender):
    OLD_FOLDER.mkdir()
    with pytest.warns(UserWarning, match=r"wsrender-data is used.*; the default is now .*\.local/share/wsrender: move"):
        assert Settings().data_dir == Path.cwd() / "wsrender-data"
    code, _, said = wsrender("keys", "list")
    assert code == 0 and said.startswith("warning: data_dir: ") and not any(OLD_FOLDER.iterdir())


def test_a_folder_that_is_named_needs_no_default(home):
    OLD_FOLDER.mkdir()
    assert Settings(data_dir=home / "data").data_dir == home / "data"
    assert not (home / "data").exists()


def test_misspelt_variables_are_refused_with_the_nearest(home, wsrender, monkeypatch):
    for name in ("WSRENDER_THREADS", "WSRENDER_CACHE_DIR", "WSRENDER_TOKEN", "WSRENDER_TEST_X", "wsrender_host"):
        monkeypatch.setenv(name, "1")
    monkeypatch.setenv("WSRENDER_MAX_STREAMS", "7")
    assert Settings().max_streams == 7
    for wrong, near in (
        ("WSRENDER_MAX_STREAM", "WSRENDER_MAX_STREAMS"),
        ("WSRENDER_DATADIR", "WSRENDER_DATA_DIR"),
        ("wsrender_prot", "WSRENDER_PORT"),
    ):
        with monkeypatch.context() as patch:
            patch.setenv(wrong, "1")
            for command in (("serve", "--port", "0"), ("keys", "list"), ("worker", "--scheduler", "tls://x:1")):
                code, _, said = wsrender(*command)
                assert (code, said.count("\n")) == (2, 1)
                assert said.endswith(f"variable {wrong} is none of the server's settings; the nearest is {near}\n")
    monkeypatch.setenv("WSRENDER_", "1")
    assert wsrender("keys", "list")[0] == 2 and not made(home)


def test_a_server_says_where_its_data_is(home, wsrender, monkeypatch):
    monkeypatch.setattr("wsrender_server.serving.serve_until_stopped", lambda _, __, listener, *___: listener.close())
    code, said, _ = wsrender("serve", "--port", "0")
    assert code == 0 and said == f"wsrender keeps its data in {home / '.local/share/wsrender'}\n"


def modes(root):
    return {path.relative_to(root).as_posix(): path.stat().st_mode & 0o777 for path in (root, *root.rglob("*"))}


def test_a_folder_that_an_earlier_version_left_open_is_closed_with_all_in_it(tmp_path):
    root = tmp_path / "data"
    for name in ("models", "partials/a", "results/b", "scratch"):
        (root / name).mkdir(parents=True)
    (root / "results/b/c").write_text("1")
    (root / "wsrender.db").write_text("")
    outside = tmp_path / "outside"
    outside.write_text("")
    (root / "link").symlink_to(outside)
    for path in (root, *root.rglob("*")):
        path.chmod(0o777 if path.is_dir() else 0o666)
    DataFolder(root, make=False)
    assert modes(root)["."] == 0o777
    DataFolder(root)
    assert {mode for name, mode in modes(root).items() if name != "link"} == {0o700, 0o600}
    assert outside.stat().st_mode & 0o777 == 0o666


def test_a_folder_of_others_is_not_closed_but_refused(tmp_path, monkeypatch):
    for name, mode, owner in (("others", 0o755, 1), ("shared", 0o1777, 0), ("theirs", 0o750, 0)):
        root = tmp_path / name
        root.mkdir()
        if name == "theirs":
            (root / "thesis.tex").touch()
        root.chmod(mode)
        with monkeypatch.context() as patch:
            patch.setattr(os, "geteuid", lambda owner=owner: os.getuid() + owner)
            with pytest.raises(InputError, match=rf"open to other users \(mode {mode:04o}\).*chmod 700"):
                DataFolder(root)
        assert root.stat().st_mode & 0o7777 == mode and not (root / "models").exists()
        DataFolder(root / "own")
        assert set(modes(root / "own").values()) == {0o700}


def test_the_folder_of_an_earlier_version_with_its_database_elsewhere_is_closed(tmp_path):
    """It has neither the database nor the folders that came later."""
    root = tmp_path / "data"
    for name in ("models", "partials", "results", "scratch"):
        (root / name).mkdir(parents=True)
    root.chmod(0o755)
    DataFolder(root)
    assert set(modes(root).values()) == {0o700} and (root / "documents").is_dir()


def test_at_the_start_scratch_of_workers_that_go_on_stays(tmp_path):
    files = DataFolder(tmp_path)
    for name in ("aa.7", "bb.7"):
        (tmp_path / "scratch" / name / "result").mkdir(parents=True)
    (tmp_path / "scratch" / "cc.json").touch()
    now = (tmp_path / "scratch" / "cc.json").stat().st_mtime
    for name in ("aa.7", "bb.7"):
        os.utime(tmp_path / "scratch" / name, (now - 9, now - 9))
    files.empty_scratch(but={"aa"}, before=now)
    assert sorted(path.name for path in (tmp_path / "scratch").iterdir()) == ["aa.7", "cc.json"]
    files.forget("aa")
    files.empty_scratch()
    assert not any((tmp_path / "scratch").iterdir())


def test_an_empty_name_of_a_database_is_that_of_the_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("WSRENDER_DATABASE", "")
    settings = Settings(data_dir=tmp_path)
    assert settings.database_url == f"sqlite:///{tmp_path / 'wsrender.db'}"
