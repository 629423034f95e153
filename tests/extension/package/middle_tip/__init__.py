"""An analysis of another package: where the tip is with all joints in the middle of their ranges."""

from wsrender.analyses.registry import Entry

ENTRY = Entry("middle_tip.job:MiddleTipJob", "middle_tip.run:MiddleTipAnalysis")
