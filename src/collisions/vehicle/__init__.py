"""The vehicle, its outline, and the drag of its tyres."""
