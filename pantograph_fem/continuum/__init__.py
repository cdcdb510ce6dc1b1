"""Sheets and beams as discrete equilibrium problems: what their kinds have in common."""
