"""`python -m gudgeon WHAT` is `gudgeon-plot WHAT`."""

import sys

from gudgeon.cli import main

sys.exit(main())
