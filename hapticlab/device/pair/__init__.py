"""Two paddles as one system: what one board measures becomes what the scene on the other hears.

In: two paddles, and a scene for each from ``hl.laws.bilateral_coupling``. Out: two recordings and the times of the link.
Read ``two_paddles`` first, then ``sides`` (one paddle of a pair, simulated or on a board), ``relay`` (messages under way,
with a delay that can be chosen) and ``coupled_run`` (what comes back).
"""
