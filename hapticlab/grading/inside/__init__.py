"""What runs in a student's process: their cells, their answers, and the walls around them. No expected value is known here."""
