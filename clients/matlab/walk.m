% Ten minutes with a server; WSRENDER_SERVER is its address, WSRENDER_TOKEN a key where it asks for one.
server = Wsrender(getenv('WSRENDER_SERVER'), getenv('WSRENDER_TOKEN'));

% Indices at one configuration; a matrix has a row for each of several.
document = struct('analysis', 'indices_at', 'robot', struct('library', 'ur5e'));
document.configurations = [0, -1.5, 1.5, 0, 1, 0];
document.indices = 'manipulability';
job = server.wait(server.submit(document));
[values, columns] = server.table(job, 'map.parquet');
fprintf('indices_at: %.9g\n', values(1, strcmp(columns, 'manipulability')));

% The workspace, its volume and its voxels.
document = struct('analysis', 'workspace', 'robot', struct('library', 'ur5e'), 'voxel_size_m', 0.1);
document.sampling = struct('method', 'sobol', 'count', 4096);
job = server.wait(server.submit(document));
result = server.result(job);
fprintf('workspace: %.9g\n', result.headline.value);
fprintf('files: %s\n', strjoin(server.files(job), ' '));
[values, columns] = server.table(job, 'volume.vtkhdf');
fprintf('voxels: %d x %d\n', size(values, 1), size(values, 2));

% What is wrong is told.
try
  server.submit(struct('analysis', 'workspace'));
catch problem
  fprintf('refused: %s\n', problem.identifier);
end

% A long job, stopped.
document.sampling.count = 1e9;
try
  server.wait(server.cancel(server.submit(document)));
catch problem
  fprintf('stopped: %s\n', problem.identifier);
end
