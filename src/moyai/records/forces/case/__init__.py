"""Files that describe force records: schema, and the tests that they state."""
