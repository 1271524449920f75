"""A paddle on a board: from opening the port to the last sample of a run.

In: a scene's program, an open port. Out: ``Telemetry``; every fault ends with the motor off.
Read ``serial_paddle`` (what the user holds), ``greeting`` and ``homing`` (before the first force), ``upload``
and ``run`` (what is loaded, what it says), ``streaming`` (a run that is looked at while it goes), and ``settings``;
``host_board`` is this computer as a board.
"""
