"""What can be asked of robots and mechanisms: one folder an analysis."""
