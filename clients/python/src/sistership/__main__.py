"""`python -m sistership`: the program, with the same arguments."""

from .program import main

main()
