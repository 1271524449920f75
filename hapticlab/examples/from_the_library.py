"""A scene of the library, led by a hand that goes to and fro.

Run it:  hapticlab run from_the_library.py --set Omega=25

The machine buzzes in the hand until Omega is what the absorber is tuned to, sqrt(k_2/m_2) = 31.6 rad/s.
"""

import numpy as np

import hapticlab as hl

scene = hl.library.tuned_absorber()
hand = hl.Hand(m=0.02, b=1.0, k=100.0, intent=lambda t: 0.01 * np.sin(2 * np.pi * 0.5 * t))
paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hand)
duration = 4.0
