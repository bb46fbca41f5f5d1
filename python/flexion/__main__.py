"""The program: ``python -m flexion run case.toml``."""

from ._program import main

main()
