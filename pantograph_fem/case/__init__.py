"""Case files: what is simulated, checked before anything is computed.

Nothing here imports numpy or dolfinx, so that a case is checked in a fraction of a second.
"""

from .loading import case_from_dict, case_to_toml, load_case
from .model import Case

__all__ = ["Case", "case_from_dict", "case_to_toml", "load_case"]
