"""moldwarp: a dynamic material point method for geomechanics.

::

    import moldwarp

    sim = moldwarp.Simulation("examples/absorbing-column")
    sim.run()
    sim.history["bottom.displacement.z"]

SI units throughout; tension positive; stresses and strains in the order xx, yy, zz, xy, yz, zx, shear
strains as engineers count them (γ = 2ε).
"""

from ._errors import (
    BusyError,
    FileError,
    FrozenError,
    MoldwarpError,
    NotAtRestError,
    SceneError,
    StoppedError,
)
from ._history import History
from ._material import Increment, Material, Update
from ._mesh import Mesh
from ._moldwarp import VERSION as __version__
from ._particles import Nodes, Particles
from ._report import Report, report
from ._scene import Scene
from ._simulation import Simulation
from ._views import Columns, Frozen, View

__all__ = [
    "BusyError",
    "Columns",
    "FileError",
    "Frozen",
    "FrozenError",
    "History",
    "Increment",
    "Material",
    "Mesh",
    "MoldwarpError",
    "Nodes",
    "NotAtRestError",
    "Particles",
    "Report",
    "Scene",
    "SceneError",
    "Simulation",
    "StoppedError",
    "Update",
    "View",
    "__version__",
    "report",
]
