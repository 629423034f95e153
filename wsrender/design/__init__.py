"""Designs and their search: parameters, evaluations, optimisers."""
