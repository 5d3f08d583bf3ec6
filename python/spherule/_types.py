# SPDX-License-Identifier: BSD-3-Clause
"""All classes that the compiled part makes or takes, where it looks them up."""

from ._error import Error
from ._results import *
from ._robots import *
from ._shapes import *
