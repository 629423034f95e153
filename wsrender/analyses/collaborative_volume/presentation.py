"""How collaborative volumes are shown."""

from wsrender.results.presentation import Presentation

PRESENTATION = Presentation(measured="collaborative")
