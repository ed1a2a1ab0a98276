"""Files that describe a survey: schema, and the survey that they state."""
