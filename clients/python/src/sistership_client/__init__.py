"""Client of Sistership: ships, trials, refinements, and their models as something to call."""

from .client import Client, Job, JobFailed, Ship, Track, UnderWay, Version
from .http import Refused

__all__ = ["Client", "Job", "JobFailed", "Refused", "Ship", "Track", "UnderWay", "Version"]
