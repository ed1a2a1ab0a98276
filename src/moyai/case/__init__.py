"""Case files: schema, reader, builder. The only place that knows YAML, degrees and file paths."""
