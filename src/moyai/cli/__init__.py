"""The command line: thin, no physics.

It hands out no names: from Python use :mod:`moyai` and the packages that the commands call.
"""
