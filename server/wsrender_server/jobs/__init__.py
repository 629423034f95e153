"""Jobs: their store, their execution on Dask, their files. Nothing here knows HTTP."""
