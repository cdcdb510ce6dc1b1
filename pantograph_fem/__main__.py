"""``python -m pantograph_fem`` is the command ``pantograph``."""

from .cli import main

main()
