"""Names of what `output.elements` writes beside the other results."""

#: The list of states, and the folder of their files.
LIST, FOLDER = "elements.pvd", "elements"
