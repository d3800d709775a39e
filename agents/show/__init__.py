"""What a person looks at: reports, plots and films.

Others use `report` (pages about an agent), `plots`, `film.write_film` and `frames` (a policy at
play, picture by picture).
"""
