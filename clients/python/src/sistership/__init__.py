"""Sistership: ship manoeuvring models, refined against trials.

Without a server: `refine`, `diagnose`, `estimate` and `Model`, by the program of this machine. With
one: `Client`."""

from .client import Client, Ship
from .http import NoAnswer, Refused
from .jobs import Job, JobFailed
from .local import diagnose, estimate, refine
from .models import Model
from .program import CommandFailed, find_program, run_command
from .reports import Report
from .tracks import Track
from .trials import Trial
from .versions import UnderWay, Version

__all__ = ["Client", "CommandFailed", "Job", "JobFailed", "Model", "NoAnswer", "Refused", "Report",
           "Ship", "Track", "Trial", "UnderWay", "Version", "diagnose", "estimate", "find_program",
           "refine", "run_command"]
