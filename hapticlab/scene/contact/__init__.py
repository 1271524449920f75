"""What happens where bodies touch: the interaction model of Fig. 23.7.

In: a gap. Out: a ``Contact`` with a law of force, of impulse, or both.
Read ``contact``, then ``penalty_laws``, ``contact_laws`` and ``felt_impulses``.
"""
