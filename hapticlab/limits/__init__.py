"""WHAT IS PROMISED: passivity, stability and design limits of a law on a sampled paddle, from theory."""
