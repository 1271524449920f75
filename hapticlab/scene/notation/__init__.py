"""The notation that students write: signals, parameters with units, cases, derivatives.

In: names, numbers, texts with units. Out: SymPy symbols that know their unit, range and value.
Read ``symbols`` and ``parameters``, ``units`` with ``metric``, ``amount`` and ``written``, then ``cases``,
``derivative`` and ``checks``.
"""
