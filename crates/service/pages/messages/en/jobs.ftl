jobs-explained = Refinements, diagnoses and work on families, the latest first.
jobs-state = State
jobs-earlier = Earlier jobs
jobs-requested = Requested
jobs-begun = Begun
jobs-ended = Ended
jobs-kind = Kind
jobs-done = Done
jobs-outcome = Outcome
job-state-queued = queued
job-state-running = running
job-state-succeeded = succeeded
job-state-failed = failed
job-state-cancelled = cancelled
job-kind-refinement = refinement
job-kind-diagnosis = diagnosis
job-kind-bulk-refinement = bulk refinement
job-kind-branch = branch
job-of-ship = { $kind } of { $ship }
job-progress = Progress
job-reloads = This page reloads every three seconds.
job-correct-and-retry = Correct what the message names, for example the <a href="/ships/{ $ship }#trials">trials</a> or the <a href="/ships/{ $ship }/particulars">particulars</a> of the ship, then retry; or <a href="/ships/{ $ship }">begin again with other settings</a>.
job-correct = Correct what the message names, then retry.
job-ship-page = Page of the ship
job-attempts = Attempts
job-stopping = The job stops at its next step.
job-cancel = Cancel
job-retry = Retry
job-request = Request
job-no-state = there is no state `{ $name }`

## Results in words

outcome-version = version { $number }, { $alias }
outcome-version-from = version { $number }, { $alias }, from { $from }
outcome-diagnosed = { $model } diagnosed: { $verdict }
outcome-lacks = { $model } diagnosed: lacks { $effects }; version { $number }
job-kind-family-prior = family prior
