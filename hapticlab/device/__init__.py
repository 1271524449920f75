"""Where a scene runs: paddles, simulated and real, behind one contract."""
