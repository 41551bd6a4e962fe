"""Client of Sistership: ships, trials, refinements, and models as callable objects."""

from .client import Client, Ship
from .http import NoAnswer, Refused
from .jobs import Job, JobFailed
from .tracks import Track
from .trials import Trial
from .versions import UnderWay, Version

__all__ = ["Client", "Job", "JobFailed", "NoAnswer", "Refused", "Ship", "Track", "Trial",
           "UnderWay", "Version"]
