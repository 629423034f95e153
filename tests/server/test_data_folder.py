"""Where the server's data is by default, and that looking makes nothing."""

from pathlib import Path

import pytest
from wsrender_server.settings import OLD_FOLDER, Settings, default_data_dir

from wsrender import cli


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


def test_a_server_says_where_its_data_is(home, wsrender, monkeypatch):
    monkeypatch.setattr("wsrender_server.serving.serve_until_stopped", lambda app, listener, *_: listener.close())
    code, said, _ = wsrender("serve", "--port", "0")
    assert code == 0 and said == f"wsrender keeps its data in {home / '.local/share/wsrender'}\n"
