"""`python -m accuray` is the command `accuray`."""

import sys

from accuray.cli import main

if __name__ == "__main__":
    sys.exit(main())
