"""A local page in the browser: a case, its errors, its figures at once, and full runs as jobs.

It has no physics and draws nothing: it uses ``case``, the kinds of structures and ``report``. The function that runs a
case is handed in by the command, so that this package stands below the command line. It hands out no names:
``moyai serve`` starts it.
"""
