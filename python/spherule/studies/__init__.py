# SPDX-License-Identifier: BSD-3-Clause
"""Many parts, very many configurations or motions, reachability maps: in chunks, on as many machines
as there are.

Each function works on threads of this machine, or, given `client=`, on the workers of a
dask.distributed Client. Results depend on neither. With `output=` a folder keeps what is done: a run
that was ended goes on from there. Dask and pyarrow are needed only where they are used.
"""

from ._checks import ConfigurationStudy as ConfigurationStudy
from ._checks import EdgeStudy as EdgeStudy
from ._checks import check_configs as check_configs
from ._checks import check_edges as check_edges
from ._parts import PartCover as PartCover
from ._parts import cover_parts as cover_parts
from ._reachability import Reachability as Reachability
from ._reachability import reachability as reachability
from ._sources import GeneratedRows as GeneratedRows
from ._sources import uniform_configurations as uniform_configurations

__all__ = [
    "ConfigurationStudy",
    "EdgeStudy",
    "GeneratedRows",
    "PartCover",
    "Reachability",
    "check_configs",
    "check_edges",
    "cover_parts",
    "reachability",
    "uniform_configurations",
]

for _name in __all__:
    globals()[_name].__module__ = __name__
del _name
