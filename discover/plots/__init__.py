"""Pictures as inline SVG: the one place that draws."""
