"""Thirty calls as the guides have them; a type checker must report none. They are checked, not run."""

import numpy as np

import wsrender as ws

arm = ws.load_robot("ur5e")
moved = ws.load_robot("arm.urdf", base="base_link", tip="tool0", limits={"joint1": (-1.0, 1.0)})
planar = ws.load_robot(
    ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.4, limits_deg=(-150, 150)), ws.DHRow(a=0.3)])
)
result = ws.analyze(arm, ws.Sobol(1_000_000), indices=["manipulability"], voxel_size_m=0.02, progress=True)
same = ws.analyze("ur5e", {"method": "sobol", "count": 1000}, indices="kinematic", constraints={"self_collision": True})
text: str = result.summary()
headline = result.document["headline"]
result.plot.slice(y=0.0, index="manipulability").savefig("slice.png")
result.save("out", formats=["vti", "csv"])
loaded = ws.Result.load("out")
figure = result.render("isosurface", "view.png", threshold=0.8)
rows: int = len(result.to_pandas()["manipulability"])
volume = result.to_xarray()["maximum_manipulability"].sel(x=0.1, method="nearest")
watertight: bool = result.to_trimesh().is_watertight
result.report("report.html", views=())
cell = ws.Environment([ws.HalfSpace(name="floor"), ws.Box(size_m=(1.0, 0.6, 0.04), position_m=(0.75, 0.0, 0.2))])
free = ws.analyze(arm, ws.Grid([10, 10, 10, 1, 1, 1]), environment=cell)
found = ws.reachable(arm, [[0.3, 0.2, 0.4]], position_tolerance_m=1e-4, seed=1)
labels: np.ndarray = found.labels
postures = ws.postures(arm, (0.3, 0.2, 0.4), (1.0, 0.0, 0.0, 0.0))
count: int = len(postures)
values = ws.evaluate_indices(arm, [0.0, -1.5, 1.5, 0.0, 1.0, 0.0], ["manipulability"])
poses: np.ndarray = arm.forward_kinematics([0, -1.5, 1.5, 0, 1, 0])
area: float = ws.exact_boundary(planar).area
inside: np.ndarray = ws.exact_boundary(planar, locked={"joint1": 0.5}).contains([[0.1, 0.2]])
polytope = ws.polytope(arm, np.zeros(6), "force", limit_N=500.0)
field = ws.force_field(arm, joint_limits={})
with ws.Client("http://127.0.0.1:8000", timeout_s=5.0) as client:
    job = client.submit({"analysis": "workspace", "robot": "ur5e"}, labels={"of": "me"}, priority=1)
    remote: ws.Result = job.wait(progress=True, timeout=60.0).result()
ws.register_index("spread", lambda sigma, m, n: sigma[0] - sigma[-1], unit="m")
