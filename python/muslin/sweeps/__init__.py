"""Many runs of one scene: what ``muslin.sweep`` and ``muslin sweep`` are made of.

``jobs`` and ``execute`` are for schedulers of one's own.
"""

from muslin.sweeps.job import Job, execute
from muslin.sweeps.sweep import Sweep, jobs, sweep

__all__ = ["Job", "Sweep", "execute", "jobs", "sweep"]
