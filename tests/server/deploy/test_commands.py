"""The commands of every recipe, run outside of what it is for, do a job."""

import pytest

from deploy.run_here import RECIPES, run
from tests.server.deploy.conftest import require

PROGRAMS = {"systemd": "systemd-analyze", "compose": "docker-compose", "kubernetes": "kubernetes-validate"}


@pytest.mark.parametrize("recipe", RECIPES)
def test_a_job(recipe, database, tmp_path):
    require(PROGRAMS[recipe])
    run(RECIPES[recipe](), tmp_path, database)
