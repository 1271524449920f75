"""What is known of a paddle: its constants, each with an interval where it was measured.

In come numbers, or the estimates of an identification; out goes a profile that every simulated paddle and every limit
takes. Read ``estimate.py``, ``drive_train.py``, ``paddle_profile.py``, ``prediction.py``, then ``profile_file.py``.
"""
