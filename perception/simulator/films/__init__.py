"""Films of tables on which a hand moves things, seen by a camera that stands or is carried, with the true poses."""
