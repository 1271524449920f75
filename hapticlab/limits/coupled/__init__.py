"""Two paddles coupled with each other: what is stable in two given hands (``two_hands``), and in every pair (``every_pair``)."""
