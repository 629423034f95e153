classdef Wsrender < handle
  % Jobs on a wsrender server, from MATLAB and GNU Octave; walk.m shows all of it.
  %
  %   server = Wsrender('http://127.0.0.1:8000', getenv('WSRENDER_TOKEN'));
  %   job = server.wait(server.submit(struct('analysis', 'workspace', 'robot', struct('library', 'ur5e'))));
  %   result = server.result(job);
  %
  % Errors have the identifier wsrender:CODE, CODE as in the server's problem documents, where the program tells it.

  properties (SetAccess = private)
    url  % address of the server
  end

  properties (Access = private)
    headers  % n x 2 cell of header fields
  end

  methods
    function self = Wsrender(url, key)
      % A server's address, and an API key where it asks for one.
      self.url = regexprep(url, '/+$', '');
      self.headers = cell(0, 2);
      if nargin > 1 && ~isempty(key), self.headers = {'Authorization', ['Bearer ' key]}; end
    end

    function job = submit(self, document)
      % Queue a job document, a struct. A single point, configuration or name stands for a list of it; other lists of
      % one item must stand in a cell, or jsonencode makes the item itself of them.
      job = self.post('/v1/jobs', jsonencode(document));
    end

    function job = wait(self, job, seconds)
      % The job when it has ended; an error where it failed, or after so many seconds (600).
      if nargin < 3, seconds = 600; end
      started = tic;
      while any(strcmp(job.state, {'queued', 'running', 'canceling'}))
        if toc(started) > seconds
          error('wsrender:wait_timeout', 'job %s is still %s after %g s', job.id, job.state, seconds);
        end
        job = self.get(['/v1/jobs/' job.id '?wait=10']);
      end
      if ~strcmp(job.state, 'succeeded')
        error(['wsrender:' job.state], 'job %s: %s', job.id, jsonencode(job.error));
      end
    end

    function document = result(self, job)
      % The result document of a job that succeeded, as a struct.
      document = self.get(['/v1/jobs/' job.id '/result']);
    end

    function names = files(self, job)
      % Names of the files of a result.
      items = self.get(['/v1/jobs/' job.id '/artifacts']).items;
      if isstruct(items), items = num2cell(items); end
      names = cellfun(@(item) item.name, items, 'UniformOutput', false);
    end

    function [values, columns] = table(self, job, name)
      % A file of numbers as a matrix, and the names of its columns; the server makes CSV of it.
      lines = strsplit(strtrim(self.text(['/v1/jobs/' job.id '/artifacts/' name '?format=csv'])), sprintf('\n'));
      columns = strsplit(strrep(strtrim(lines{1}), '"', ''), ',');
      numbers = cellfun(@(line) str2double(strsplit(strtrim(line), ',')), lines(2:end), 'UniformOutput', false);
      values = vertcat(numbers{:});
    end

    function job = cancel(self, job)
      % Stop a job.
      job = self.post(['/v1/jobs/' job.id ':cancel'], '');
    end

    function value = get(self, path)
      % What the server answers at a path, as a struct.
      value = jsondecode(self.text(path));
    end
  end

  methods (Access = private)
    function answer = text(self, path)
      options = weboptions('ContentType', 'text', 'Timeout', 60);
      if ~isempty(self.headers), options.HeaderFields = self.headers; end
      answer = webread([self.url path], options);
    end

    function value = post(self, path, body)
      if exist('OCTAVE_VERSION', 'builtin')
        value = jsondecode(self.curl(path, body));
      else  % not run here: this branch needs MATLAB
        options = weboptions('MediaType', 'application/json', 'ContentType', 'text', 'Timeout', 60);
        if ~isempty(self.headers), options.HeaderFields = self.headers; end
        value = jsondecode(webwrite([self.url path], body, options));
      end
    end

    function answer = curl(self, path, body)
      % Octave's webwrite sends forms only. Key and body go through files: arguments are seen by others on the machine.
      names = strrep({tempname(), tempname(), tempname()}, '\', '/');  % a backslash is an escape in curl's settings
      [sent, settings, received] = names{:};
      clean = onCleanup(@() cellfun(@delete_file, names));
      write_file(sent, body);
      lines = {'silent', 'max-time = 60', 'header = "Content-Type: application/json"', 'write-out = "%{http_code}"', ...
               ['url = "' self.url path '"'], ['data-binary = "@' sent '"'], ['output = "' received '"']};
      if ~isempty(self.headers), lines{end + 1} = ['header = "' self.headers{1} ': ' self.headers{2} '"']; end
      write_file(settings, strjoin(lines, sprintf('\n')));
      [failed, status] = system(['curl --config "' settings '"']);
      if failed, error('wsrender:connection_failed', 'no server answers at %s', self.url); end
      answer = fileread(received);
      if str2double(status) >= 400
        raise(answer, status);
      end
    end
  end
end

function raise(answer, status)
  try
    problem = jsondecode(answer);
    code = problem.code; detail = problem.detail;
  catch  % not the server's own answer, but that of a proxy before it
    error('wsrender:http_status', 'HTTP status %s: %s', status, answer);
  end
  error(['wsrender:' code], '%s', detail);
end

function write_file(name, text)
  file = fopen(name, 'w');
  if file < 0, error('wsrender:file', 'cannot write %s', name); end
  % Only its user may read it: it may hold a key.
  if isunix(), system(['chmod 600 "' name '"']); end
  fwrite(file, text);
  fclose(file);
end

function delete_file(name)
  if exist(name, 'file'), delete(name); end
end
