"""The sheet as a boundary value problem: a discretised energy held by two grips."""
