"""A picture of another package, in one file: how far samples are from the base."""

import numpy as np
from matplotlib.figure import Figure

import wsrender as ws


def distances(plot, bins=30):
    figure = Figure()
    axes = figure.add_subplot()
    axes.hist(np.linalg.norm(plot.samples.position, axis=1), bins)
    axes.set(xlabel="distance [m]", title=plot.title)
    return figure


DISTANCES = ws.Picture("distances", distances, "Distances of samples from the origin", ("samples",))
