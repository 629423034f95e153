"""
Which link lengths are best?
============================

Numbers of any job document can be parameters of a design, numbers of its result what is improved: here the platform
and the links of a 6-PUS mechanism, for the largest exact volume.
"""

import wsrender as ws

parameters = [
    {"name": "platform", "pointers": ["/mechanism/platform_m"], "bounds": [1, 3]},
    {"name": "link", "pointers": ["/mechanism/link_m"], "bounds": [2.25, 2.5]},
]
search = {"method": "sweep", "steps": [7, 5]}
design = {"analysis": "parallel_workspace", "mechanism": "six_pus", "device": "cpu"}
best = ws.design_optimization(design, parameters, [{"value": "exact_volume"}], search=search)
print(best.document["best"]["values"], best.document["best"]["parameters"])

# Picture: The exact volume over the size of the platform and the length of the links, highest along one edge.
best.plot.sweep()
