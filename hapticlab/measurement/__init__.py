"""INSTRUMENTS: what a rendered law does at the handle, measured on a paddle, simulated or real."""
