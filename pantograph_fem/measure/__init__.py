"""Measurements: functions of the positions of a few material points, and their derivatives."""

from .instruments import Instrument, instrument
from .panel import InstrumentPanel

__all__ = ["Instrument", "InstrumentPanel", "instrument"]
