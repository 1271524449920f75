"""What happens where bodies touch: the interaction model of Fig. 23.7.

In: a gap. Out: a ``Contact`` with a law of force, of impulse, or both.
Read ``contact_law`` (what a law is), ``penalty_laws`` and ``instant_laws``, then ``contact`` and ``felt_impulses``.
"""
