"""Tools for the robots under ``mjcf/``: what their READMEs repeat, fitted shapes, models of other packages."""
