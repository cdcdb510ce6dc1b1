"""``kind = "beam"``: the extensible beam of energy (16)."""
