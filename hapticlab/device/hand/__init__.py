"""Hands on a handle: passive ones, ones that intend a motion, and ones that react.

In: names or numbers. Out: a ``Hand`` whose dynamics join the plant.
Read ``hand`` and ``hand_presets``, then ``intents`` and ``reacting_hand``.
"""
