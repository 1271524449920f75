"""What a program takes on a board: time, memory and the link; and the C tables of the firmware.

In: a ``Program`` and the name of a board. Out: microseconds and bytes, a sentence, or the settings that fit.
Read ``board_records``, then ``cost`` with ``large_angles`` and ``link_traffic``, ``board_fit`` (what would fit) and
``cost_plot``; ``c_headers`` writes the firmware's tables.
"""
