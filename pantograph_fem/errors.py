"""Errors that a user can act on; each has its exit code on the command line."""


class PantographError(Exception):
    """Anything that went wrong and is explained in the message; exit code 1."""

    exit_code = 1


class CaseError(PantographError):
    """The case file, the mesh or the arguments are wrong; exit code 2.

    The message names the key, the value and what is allowed.
    """

    exit_code = 2


class PathError(PantographError):
    """The equilibrium path could not be followed to the end; exit code 3.

    The message names the load, the cause and a setting to try. What was accepted before is kept.
    """

    exit_code = 3
