"""Submissions that are broken, greedy or malicious, as data, and the small lab that they hand in."""
