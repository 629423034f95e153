"""A result as one HTML page that opens from disk, without a network."""

from wsrender.results.report.page import Picture, report_page

__all__ = ["Picture", "report_page"]
