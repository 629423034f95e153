"""
How is a master's workspace mapped into its slave's?
====================================================

Teleoperation: the largest scale at which a slave's workspace still fits into its master's, and
where.
"""

import wsrender as ws

search = {"scale": [0.02, 1.0], "offset_m": [[-0.1, 0.25], [-0.1, 0.1], [-0.1, 0.2]]}
result = ws.master_slave_mapping("phantom_omni", "slave_5r", search=search, device="cpu")
print(result.summary())

# Picture: The slave's positions, scaled and shifted into the master's workspace, all inside.
result.plot.mapping()
