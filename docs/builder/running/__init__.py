"""What runs the code of pages and labs, and what comes of it: words, figures, and live views in frames."""
