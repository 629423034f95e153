"""Entries that are none, and one whose name wsrender has."""

from wsrender.analyses.registry import Entry

TEXT = "capability"
NO_JOB = Entry(dict, print)
OTHER_NAME = Entry("wsrender.analyses.workspace.job:WorkspaceJob", print)
TAKEN = Entry("wsrender.analyses.workspace.job:WorkspaceJob", print)
