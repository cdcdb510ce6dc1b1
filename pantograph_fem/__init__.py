"""Second-gradient finite elements for pantographic sheets and the beams they are made of."""

__version__ = "0.1.0"
