"""The spring laws of the chapter as weights on past positions, named once for scenes and for their limits.

The force of a law is ``F[n] = K*(TAPS[0]*x[n] + TAPS[1]*x[n-1] + ... + LEAD*T*v[n])``, penetration counted from x_o.
Every law has the gain K at rest; all but the plain one look half a period ahead, which is what the hold loses.
"""

#: weights on x[n], x[n-1], x[n-2]
TAPS = {
    "zoh": (1.0,),  # Eq. (23.1)
    "half_sample": (1.0,),  # Eq. (23.3), with LEAD
    "backward_difference": (1.5, -0.5),  # Eq. (23.5)
    "ellis": (2.0, -1.5, 0.5),  # Eq. (23.7)
}

#: weight on T*v[n]; only Eq. (23.3) looks at a velocity
LEAD = {"zoh": 0.0, "half_sample": 0.5, "backward_difference": 0.0, "ellis": 0.0}
