"""Whether it was understood: exercises, what answers give, how they are judged, and the labs they belong to."""
