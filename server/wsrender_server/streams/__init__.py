"""Live streams: a process with a fixed-step loop for each session, and the link to it."""
