"""Thirty wrong calls of the clients, one a line, each of which a type checker must report. They are not run."""

import wsrender as ws

client = ws.Client()
job = client.job("1")
result = job.result()
batch = client.batch()
stream = client.kinetostatic_stream("phantom_omni")
awaited = ws.AsyncClient()

# Each line below is wrong.
ws.Client("http://lab:8000", "secret", 5.0)
ws.Client(tokn="secret")
ws.AsyncClient(timeout="long")
client.robots()[0]["payload"]
len(client.analyses()[0].id)
client.workers(busy=True)
client.upload_model(3)
client.submit("ur5e")
client.submit([{"analysis": "workspace"}])
client.submit({"analysis": "workspace"}, priority="high")
client.submit({"analysis": "workspace"}, labels={"of": 3})
client.estimate()
client.estimate({"analysis": "workspace"})["second"]
client.estimate({"analysis": "workspace"})["seconds"] / 60
client.job(3)
client.job("1", state="queued")
client.jobs(state="done")
client.jobs(label="of=me")
print(next(client.jobs()).stat)
job.wait(on_interrupt="stop")
job.record["finished"]
job.progress["fractions"]
job.error["detail"]
job.download()
job.events(3)
result.to_xaray()
batch.submit({"analysis": "workspace"}).results()
client.batch(at_once="many")
stream.exchange([0.0, 0.0, 0.0], scale="huge")
print(awaited.submit({"analysis": "workspace"}).id)
