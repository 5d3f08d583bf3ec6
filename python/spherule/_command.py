# SPDX-License-Identifier: BSD-3-Clause
"""The command `spherule`, where it was installed with the module."""

import os
import sys
from pathlib import Path


def main() -> None:
    """Becomes the command."""
    command = Path(__file__).parent / "bin" / "spherule"
    if not command.exists():
        sys.exit(f"spherule: there is no {command}: the module was installed without the command")
    os.execv(command, ["spherule", *sys.argv[1:]])
