"""How a scene runs: one typed straight-line program, and three engines that execute it."""
