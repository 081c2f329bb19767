"""The Blender extension: File > Import and File > Export of `.nisp`.

Blender hands this module `register` and `unregister`; what needs Blender is imported there, so that
`nisp_process` can be tested without.
"""


def register() -> None:
    """Add the operators, their menu entries and the preferences."""
    from . import operators, preferences

    preferences.register()
    operators.register()


def unregister() -> None:
    """Take all of them away again."""
    from . import operators, preferences

    operators.unregister()
    preferences.unregister()
