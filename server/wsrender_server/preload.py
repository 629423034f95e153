"""For ``dask worker --preload wsrender_server.preload``: makes workers of any Dask cluster compute for a server.

Settings are environment variables WSRENDER_… of the worker; the data folder must be the server's. Dask's nanny does not
load this, so that ``DASK_DISTRIBUTED__WORKER__DAEMON=False`` must be one of the variables.
"""

from distributed import Worker

from wsrender_server.jobs.worker import Kernels
from wsrender_server.settings import Settings


async def dask_setup(worker: Worker) -> None:
    """Called by Dask before the worker registers."""
    await worker.plugin_add(plugin=Kernels(Settings().model_dump()), catch_errors=False)
