"""The first power-up of a paddle, step by step: what each part does, predicted and found, in one report.

In: a board, the person who owns it, a switch in reach. Out: the evidence by which the board ceases to be untried.
Read ``steps``, what each asks and expects; ``bench``, which walks through them; ``motor_off``, ``stop_times``, ``limits`` and
``forces``, what each measures with what they have ``shared``; ``lag``; ``about`` and ``report``; ``practised``, a simulated
owner.
"""
