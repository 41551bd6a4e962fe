"""Client of Sistership: ships, trials, refinements, and their models as something to call."""

from .client import Client, Ship
from .http import NoAnswer, Refused
from .jobs import Job, JobFailed
from .tracks import Track
from .trials import Trial
from .versions import UnderWay, Version

__all__ = ["Client", "Job", "JobFailed", "NoAnswer", "Refused", "Ship", "Track", "Trial",
           "UnderWay", "Version"]
