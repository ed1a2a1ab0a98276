"""Reports: figures, animated side view, HTML and PDF."""
