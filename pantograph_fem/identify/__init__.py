"""Constants of a sheet from measured forces, angles, elongations and markers.

:func:`~pantograph_fem.identify.identify.identify` finds them;
:func:`~pantograph_fem.identify.write.write` writes what was found.
"""
