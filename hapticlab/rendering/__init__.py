"""LAWS OF A MODEL: force laws designed on what is known of the paddle and the hand."""
