"""WHAT A PERSON FEELS AND DOES: psychophysics, targets, juggling, shared control."""
