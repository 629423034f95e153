"""Ten minutes with the client that openapi-python-client makes of a server's description: walk.py URL [KEY]."""

import io
import sys
import time

from wsrender_generated import AuthenticatedClient
from wsrender_generated.api.jobs import cancel_job, get_job, submit_job, validate_job
from wsrender_generated.api.models import upload_model
from wsrender_generated.api.results import get_artifact, get_plot, get_result, get_slice, list_artifacts
from wsrender_generated.models import (
    Estimate,
    GetPlotPlot,
    IndicesAtSubmission,
    JobState,
    JobView,
    LibraryRobot,
    LibraryRobotLibrary,
    PageArtifactView,
    Problem,
    ResultDocument,
    Sobol,
    UploadedModelView,
    UploadedRobot,
    WorkspaceSubmission,
)
from wsrender_generated.types import File

MODEL = b"""<mujoco><worldbody><body><joint name="a" axis="0 0 1" range="-90 90"/><geom size="0.1"/>
<body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-90 90"/><geom size="0.1"/><site name="tool" pos="0.5 0 0"/>
</body></body></worldbody></mujoco>"""
UNFINISHED = (JobState.QUEUED, JobState.RUNNING, JobState.CANCELING)


def wait(client: AuthenticatedClient, job: JobView) -> JobView:
    """The job when it has ended."""
    while job.state in UNFINISHED:
        view = get_job.sync(job.id, client=client, wait=30)
        assert isinstance(view, JobView), view
        job = view
    return job


def submit(client: AuthenticatedClient, body: IndicesAtSubmission | WorkspaceSubmission) -> JobView:
    """The job of a body; a key of its own makes the request safe to repeat."""
    job = submit_job.sync(client=client, body=body, idempotency_key=str(time.time_ns()))
    assert isinstance(job, JobView), job
    return job


def main() -> None:
    """Submit, wait, look, download, upload, cancel."""
    url, *key = sys.argv[1:]
    client = AuthenticatedClient(url, token=key[0] if key else "none")  # a server without keys takes any
    robot = LibraryRobot(library=LibraryRobotLibrary.UR5E)

    job = wait(client, submit(client, IndicesAtSubmission(robot=robot, configurations=[[0, -1.5, 1.5, 0, 1, 0]])))
    result = get_result.sync(job.id, client=client)
    assert job.state == JobState.SUCCEEDED and isinstance(result, ResultDocument), job.error
    print("indices_at:", sorted(result.additional_properties))

    body = WorkspaceSubmission(robot=robot, sampling=Sobol(count=200_000), voxel_size_m=0.05, refined_volume=None)
    estimate = validate_job.sync(client=client, body=body)
    assert isinstance(estimate, Estimate) and estimate.valid, estimate
    job = wait(client, submit(client, body))
    assert job.state == JobState.SUCCEEDED, job.error
    page = list_artifacts.sync(job.id, client=client)
    assert isinstance(page, PageArtifactView)
    for item in page.items:
        file = get_artifact.sync(job.id, item.name, client=client)
        assert isinstance(file, File), item.name
        content = file.payload.read()
        rest = get_artifact.sync(job.id, item.name, client=client, range_="bytes=100-", if_range=f'"{item.sha256}"')
        assert isinstance(rest, File), rest  # a download that broke off goes on
        assert len(content) == item.bytes_ and rest.payload.read() == content[100:], item.name
    plane = get_slice.sync(job.id, client=client)
    assert isinstance(plane, File) and plane.payload.read(6) == b"\x93NUMPY"
    plot = get_plot.sync(job.id, GetPlotPlot.SLICES, client=client)
    assert isinstance(plot, File) and plot.payload.read(4) == b"\x89PNG"
    print("workspace:", [item.name for item in page.items])

    model = upload_model.sync(client=client, body=File(io.BytesIO(MODEL)))
    assert isinstance(model, UploadedModelView), model
    long = WorkspaceSubmission(robot=UploadedRobot(model=model.sha256), sampling=Sobol(count=10**10), voxel_size_m=0.01)
    canceled = cancel_job.sync(submit(client, long).id, client=client)
    assert isinstance(canceled, JobView), canceled
    print("cancel:", wait(client, canceled).state)

    refused = submit_job.sync(client=client, body=WorkspaceSubmission(robot=robot, voxel_size_m=-0.05))
    assert isinstance(refused, Problem), refused
    print("refused:", refused.code, refused.errors[0].pointer if refused.errors else "")


if __name__ == "__main__":
    main()
