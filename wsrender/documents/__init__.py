"""The language of job documents (pydantic), shared by Python, the command line and the server; no analysis is in it."""
