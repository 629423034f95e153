"""Results: the result document with its data, files, pictures and pages."""
