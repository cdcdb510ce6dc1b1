"""Solvers for equilibrium problems that they know only by residual, tangent and load rate."""
