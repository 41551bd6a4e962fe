## Condition and next step

ship-family = family
ship-condition = Condition
ship-since = This applies since the trial { $trial }, uploaded { $at }.
ship-diagnosis-report = Report of the diagnosis
ship-with-effects = <a href="{ $address }">Version { $number }</a> is the model with the missing effects; promote it below if you agree.
ship-based-on = Based on { $count } diagnoses
ship-all-trials = all trials: { $trials }
verdict-complete = complete
verdict-effects = effects
verdict-unexplained = unexplained
verdict-drift = drift
condition-no-champion = Unknown: it has no champion yet.
condition-not-diagnosed = Unknown: its champion has not been diagnosed on a trial yet.
condition-holds = Its model holds: on { $trials } the residual agrees with the noise.
condition-count-trials = { $count ->
        [one] 1 trial
       *[other] { $count } trials
    }
condition-fails = Its model does not hold: { $evidence }.
condition-fails-since = Its model does not hold since the trial { $since }: { $evidence }.
condition-some-trials = { $against } of { $all }
condition-lacks = on { $trials } it lacks { $effects }
condition-lacks-more = on { $trials } it lacks { $effects }, and something that no known effect explains
condition-unexplained = on { $trials } something is missing that no known effect explains
condition-drifted = the unexplained force on new trials is { $ratio } times that on the fitted trials (axis { $axis })
next-label = Next step
next-job-runs = A { $kind } of this ship is under way: { $percent } %.
next-see-progress = See its progress
next-no-trials = The ship has no trials yet. Turning circles and zigzags tell most.
next-upload = Upload trials
next-not-refined = The ship has trials, and no model that is fitted to them.
next-refine = Refine its model
next-has-effects = Version { $number } has the missing effects.
next-look-at-version = Look at version { $number }
next-none-in-use = No version is in use yet.
next-look-at-newest = Look at the newest version
next-newer = Version { $number } is in use, and there is a newer one.
next-compare = Compare them
next-not-diagnosed = Version { $number } was not diagnosed since it came into use.
next-diagnose = Diagnose it
next-has-report = Version { $number } is in use. Its report has the verdict on it.
next-look-at-report = Look at the report
next-in-use = Version { $number } is in use.
next-look-at-it = Look at it

## Actions

actions-heading = More actions: upload, refine, diagnose, promote, tags, notes
action-upload-explained = CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 or 2000; the channel of each column is shown and can be corrected before the trials are stored.
action-choose-files = Choose files
action-refine = Refine
action-refine-explained = Fits a model to all trials of the ship. With the default settings all sources, laws and methods are compared by their errors on held-out manoeuvres.
method-select = compare all and select the best
method-weak = weak: equations integrated over windows
method-trajectory = trajectory: least squares on simulated segments
method-published = published: one-step differences
method-cma-es = cma-es: evolutionary search on simulations
action-diagnose = Diagnose
action-diagnose-explained = Tests whether a version still describes the motion of the ship, on trials that it was not fitted to, and if not, finds the missing effects.
action-promote = Promote, or roll back
action-promote-explained = The champion is the version in use. If it has been changed by another user since this page was loaded, the request is refused. Every change is recorded with its reason.
action-champion-mark = (champion)
action-make-champion = Make it champion
action-roll-back = Roll back to version { $number }
action-roll-back-reason = rolled back on the ship's page
action-tags = Tags
action-remove-tag = Remove the tag { $tag }
action-remove = remove
action-new-tag = New tag
action-add-tag = Add tag
action-note = Note
action-note-explained = Information for other users, such as work on the hull. Notes cannot be changed and show their author.
action-add-note = Add note

## Versions and trials

ship-versions = Versions of its model
ship-aliases = Aliases
ship-made-from = Made from
ship-by = By
ship-mark-version = Mark version { $number }
ship-report-link = report
ship-no-versions = None yet: upload trials and refine.
ship-compare-marked = Compare the marked versions
ship-all-versions = All versions as JSON
ship-compare-newest = Compare the two newest
ship-simulate = Simulate the champion
ship-champion-yaml = Champion as YAML
ship-state-conditions = State their date, place, weather and loading
ship-all-trials-json = All trials as JSON
ship-notes = Notes
ship-all-notes = All notes as JSON

## Particulars and similar ships

ship-particulars = Particulars
ship-change-particulars = Change the particulars
ship-revision = Revision { $number } of the ship's document
ship-particular = Particular
ship-drawing-explained = To scale: length, beam, draught, depth, rudder and propeller as stated. The hull lines are schematic.
drawing-label = { $title } to scale: length { $length } m, beam { $beam } m
drawing-midship = midship, beam { $beam } m
drawing-gravity = G { $distance } m from midship
drawing-draught = draught { $draught } m
drawing-rudder = rudder { $area } m²
drawing-propeller = propeller diameter { $diameter } m
ship-similar = Similar ships
ship-eligible = Eligible as source
ship-reasons = Reasons
ship-none-comparable = No other ship is comparable.
ship-all-by-similarity = All ships by similarity
ship-ranking-json = Ranking that also uses the trials, as JSON
