"""``kind = "lattice"`` and ``kind = "chain"``: the springs of energies (19) and (1)."""
