"""WHAT THE PADDLE AND THE HAND ARE: their constants from records, with confidence intervals."""
