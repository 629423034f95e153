"""The measures of sets of positions: what a set of each dimension has, and its units."""

QUANTITIES = {1: "length", 2: "area", 3: "volume"}
"""By dimension."""
UNITS = {"volume": "m3", "area": "m2", "length": "m"}
"""As result documents write them."""
TABLE_UNITS = {"m3": "m^3", "m2": "m^2", "m": "m"}
"""As tables have them."""
NOT_ASKED = "refined_volume is null: none was asked for"
"""Why a result has no measure with an interval, where it might have one."""
