"""What every room uses: arguments checked in words, telemetry, statistics, drawing and the types of annotations."""
