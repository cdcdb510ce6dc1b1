"""The commands of ``pantograph``, one a module; each imports what it needs when it is called."""
