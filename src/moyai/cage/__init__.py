"""Net cages: the rigid cage of small models, flexible cages, their moorings and their analyses."""
