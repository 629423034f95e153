"""Colours that the colour-blind tell apart (Okabe and Ito, *Color universal design*, 2008)."""

BLUE, VERMILION, GREEN, PURPLE = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
ORANGE, SKY_BLUE, YELLOW = "#e69f00", "#56b4e9", "#f0e442"

# Of targets, of poses, and of which of two arms serves a target.
VERDICTS = {"reachable": GREEN, "blocked": BLUE, "unreachable": VERMILION, "undecided": ORANGE}
VERDICTS |= {"first": BLUE, "second": PURPLE, "both": GREEN, "free": GREEN, "none": VERMILION}

POLYTOPES = {"velocity": BLUE, "force": VERMILION, "acceleration": GREEN}
