"""What a student sees of a check: the card in text and in HTML, and the progress of the lab."""
