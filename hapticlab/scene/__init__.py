"""What is felt: signals, parameters and coordinates with units, scenes, and the chapter's laws."""
