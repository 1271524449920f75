"""What happened: limits that say what they are, chatter, energy at the port, sweeps and their plots."""
