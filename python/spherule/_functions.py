# SPDX-License-Identifier: BSD-3-Clause
"""Functions that are better written in Python: many options, or little work."""

from typing import Sequence

from . import _core
from ._arguments import MeshLike, Progress
from ._results import Simplification
from ._shapes import Zone

__all__ = [
    "simplify",
    "sphere_tree",
]


def simplify(
    mesh: MeshLike,
    *,
    max_error: float = 0.0,
    levels: Sequence[float] = (),
    min_external_diameter: float = 0.0,
    tightness: float = 0.03,
    padding: float = 0.0,
    min_radius: float = 0.0,
    zones: Sequence[Zone] = (),
    keep_concave_edges: bool = False,
    method: str = "cover",
    external: str = "reachable",
    external_limit: int = 100000,
    min_internal_diameter: float = 0.0,
    seed: int = 1,
    effort: int = 60,
    seconds: float = 0.0,
    lower_bound: bool = False,
    history: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Simplification:
    """Both stages and the certificate: the function that most users call.

    Lengths are in the unit of the mesh. `max_error` is E, how far the result may protrude from the
    simplified solid (0: 1 % of the box diagonal); `levels` are errors of levels of detail above the
    cover; `min_external_diameter` is D, the diameter of the smallest object to be checked against
    the mesh (0: 4 E, or more where that would take too much memory; `result.larger_diameter` says so,
    and `result.external` has the one that was used), and `tightness` how much wider than D a way may
    be and still be filled, as a share of D. `padding` grows the mesh; no sphere is smaller than
    `min_radius`. In `zones`, and with `keep_concave_edges` along sharp concave edges, E and D are
    smaller. `method` is 'cover' or
    'paper', `external` 'reachable', 'random' (of `external_limit` attempts) or 'none'. `effort` are
    rounds of searching for fewer spheres, `seconds` its limit in time (0: none). The result does
    not depend on `threads` (0: all).
    """
    options = dict(locals())
    del options["mesh"], options["progress"]
    result: Simplification = _core._simplify(mesh, progress, **options)
    return result


def sphere_tree(simplification: Simplification) -> _core.SphereTree:
    """The tree over the spheres: through the levels, where some were fitted."""
    if not simplification.levels:
        return _core.build_tree(simplification.spheres)
    return _core.build_tree_from_levels(simplification.spheres, simplification.levels)[0]
