"""One scene at many parameter points, in lanes and on all processors.

In: a scene, a paddle, arrays of parameter values. Out: a grid of measures, which a file can hold half done.
Read ``sweep`` (what the user calls), ``sweep_plan``, ``sweep_grid``, ``sweep_measures`` and ``lane_runs``; then
``sweep_chunks``, ``workers``, ``forked_workers`` and ``sweep_file`` (side by side, and resumed).
"""
