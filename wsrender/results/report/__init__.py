"""A result as one HTML page that opens from disk, without a network."""

from wsrender.results.report.page import ShownPicture, report_page

__all__ = ["ShownPicture", "report_page"]
