"""Files that describe streak images: schema, and the campaign that they state."""
