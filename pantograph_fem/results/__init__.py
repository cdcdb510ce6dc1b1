"""What a run leaves behind and shows: plain data on one process, no solving."""
