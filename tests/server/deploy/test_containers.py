"""Compose and Kubernetes: what their own schemas and programs say of the files, and what these do not see."""

import shutil
import subprocess

import pytest
import yaml

from deploy.run_here import of_compose
from tests.server.deploy.conftest import RECIPES, require

COMPOSE, GPUS, KUBERNETES = RECIPES / "compose.yaml", RECIPES / "compose.gpu.yaml", RECIPES / "kubernetes.yaml"


def validate(file):
    """Faults of a file by its schema."""
    command = ["check-jsonschema", "--builtin-schema", "vendor.compose-spec"]
    command = ["kubernetes-validate", "--strict"] if "kubernetes" in file.name else command
    require(command[0])
    return subprocess.run([*command, file], capture_output=True, text=True)


def changed(file, folder, right, wrong):
    """A copy of a recipe with something else in it."""
    folder = shutil.copytree(RECIPES, folder / "deploy")
    text = file.read_text()
    assert right in text
    (folder / file.name).write_text(text.replace(right, wrong, 1))
    return folder / file.name


@pytest.mark.parametrize("file", [COMPOSE, GPUS, KUBERNETES], ids=lambda file: file.name)
def test_schemas(file):
    validated = validate(file)
    assert validated.returncode == 0, validated.stdout + validated.stderr


@pytest.mark.parametrize(
    ("file", "right", "wrong"),
    [
        (COMPOSE, "read_only:", "read_olny:"),
        (GPUS, "capabilities: [gpu]", "capability: [gpu]"),
        (KUBERNETES, "automountServiceAccountToken:", "automountServiceAccount:"),
        (KUBERNETES, "replicas: 2", "replicas: two"),
    ],
)
def test_schemas_find_what_is_wrong(tmp_path, file, right, wrong):
    assert validate(changed(file, tmp_path, right, wrong)).returncode != 0


def test_compose_reads_its_files():
    require("docker-compose")
    services = {process.name: process for process in of_compose()}
    assert services["worker"].replicas == 2
    assert list(services).index("upgrade") < list(services).index("server")
    with_gpus = {process.name: process for process in of_compose((COMPOSE, GPUS))}
    assert with_gpus["worker"].command[-2:] == ["--gpus", "all"]
    assert with_gpus["worker"].replicas == 1


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [("secrets: [ca.pem,", "secrets: [authority,", "authority"), ("{upgrade: {", "{update: {", "update")],
)
def test_compose_finds_references_to_nothing(tmp_path, right, wrong, told):
    require("docker-compose")
    with pytest.raises(ValueError, match=told):
        of_compose((changed(COMPOSE, tmp_path, right, wrong),))


def test_kubernetes_adds_no_settings_of_its_own():
    """By default it sets WSRENDER_PORT to the address of a service called wsrender, which no server takes."""
    documents = list(yaml.safe_load_all(KUBERNETES.read_text()))
    pods = [document["spec"]["template"]["spec"] for document in documents if document["kind"] == "Deployment"]
    assert len(pods) == 3
    assert [pod["enableServiceLinks"] for pod in pods] == [False] * 3
