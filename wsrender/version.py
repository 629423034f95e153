"""The version of wsrender, by itself: errors name it, and everything imports errors."""

__version__ = "0.11.0"
