"""Setting a paddle up: connecting, flashing, calibrating, and finding out what is wrong.

In: a board, a person beside it. Out: settings stored on the board, or a list of findings with a cure each.
Read ``connect``; ``before_flash``, ``flash`` and ``intel_hex``, ``drive``; ``calibrate`` with ``wiring_check`` (which asks what
is ``built``, and looks at ``sensor_readings``), ``stops``, ``sign_check``, ``force_constant`` and ``force_fit``, asking the
``person``; ``stored_settings``; ``practice``; ``doctor`` with ``doctor_checks`` and ``computer_checks``.
"""
