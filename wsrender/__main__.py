"""``python -m wsrender``: the command line."""

from wsrender.cli import main

if __name__ == "__main__":
    main()
