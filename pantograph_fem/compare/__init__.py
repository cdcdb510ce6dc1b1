"""Results side by side: quantities, differences, observed orders of convergence, figures."""

from .compare import CompareResult, compare, write
from .comparison import Comparison

__all__ = ["CompareResult", "Comparison", "compare", "write"]
