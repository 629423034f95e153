# Not run here. A job from Julia, with the packages HTTP and JSON: julia walk.jl
using HTTP, JSON

const SERVER = rstrip(get(ENV, "WSRENDER_SERVER", "http://127.0.0.1:8000"), '/')
const KEY = get(ENV, "WSRENDER_TOKEN", "")

"What the server answers, read from JSON; an error with the code and detail of its problem document."
function ask(method, path, document = nothing)
    headers = ["Content-Type" => "application/json"]
    isempty(KEY) || push!(headers, "Authorization" => "Bearer $KEY")
    body = document === nothing ? "" : JSON.json(document)
    answer = JSON.parse(String(HTTP.request(method, SERVER * path, headers, body; status_exception = false).body))
    haskey(answer, "code") && error("$(answer["code"]): $(answer["detail"])")
    return answer
end

"The result document of a job document."
function run_job(document)
    job = ask("POST", "/v1/jobs?wait=30", document)
    while job["state"] in ("queued", "running", "canceling")
        job = ask("GET", "/v1/jobs/$(job["id"])?wait=30")
    end
    job["state"] == "succeeded" || error("job $(job["id"]): $(JSON.json(job["error"]))")
    return ask("GET", "/v1/jobs/$(job["id"])/result")
end

result = run_job(Dict(
    "analysis" => "indices_at",
    "robot" => Dict("library" => "ur5e"),
    "configurations" => [[0, -1.5, 1.5, 0, 1, 0]],
    "indices" => ["manipulability"],
))
println("indices_at: ", result["indices"]["manipulability"]["maximum"])
