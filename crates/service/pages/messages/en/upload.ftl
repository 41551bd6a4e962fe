## Files are chosen

upload-title = Upload trials of { $ship }
upload-explained = Choose the files of one or more trials: CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 or 2000. Files with the same columns are separate trials; a file with other columns is read as a further sensor of the trial with the most similar name. The next page shows the channel of each column and a preview; the trials are stored only after your confirmation.
upload-files = Files
upload-preview = Preview

## Reading of the columns

mapping-title = Check the upload for { $ship }
mapping-kicker = upload
mapping-heading = Check the upload
mapping-accepted = <strong>All files can be read.</strong> Check the marked columns, correct them where necessary, and store the trials.
mapping-refused = <strong>Some files cannot be read yet.</strong> The errors are listed below each file. Correct the columns and check again.
mapping-offer = { $file } has the same columns as the template <strong>{ $template }</strong>.
mapping-use-offer = Use this template
mapping-by-template = The columns are read by the template <strong>{ $template }</strong>.
mapping-columns = Columns
mapping-column = Column
mapping-read-as = Read as
mapping-sign = Sign
mapping-confidence = Confidence
mapping-over-99 = over 99 %
mapping-why = Why
mapping-channel-of = Channel of { $column }
mapping-ignored = ignored
mapping-unit-of = Unit of { $column }
mapping-reverse = Reverse the sign of { $column }
mapping-reversed = reversed
mapping-check = check:
mapping-given = given on this page
mapping-signs = Signs and frames
mapping-rudder = Positive rudder
mapping-rudder-starboard = turns the ship to starboard
mapping-rudder-port = turns it to port
mapping-velocity = u and v are speeds
mapping-velocity-ground = over the ground
mapping-velocity-water = through the water
mapping-missing = Rows with a missing value
mapping-missing-bridge = are filled where the gap is short
mapping-missing-drop = are skipped
mapping-missing-refuse = refuse the file
mapping-derive = Derive from track and heading
mapping-file = File
mapping-manoeuvre-of = Manoeuvre of { $file }
mapping-manoeuvre-example = zigzag 10/10
mapping-depth-of = Depth of { $file }
mapping-diagnose = Diagnose the ship's champion on the new trials
mapping-check-again = Check again
mapping-store = Store the trials

## Exclusions

excluded-heading = Excluded values
excluded-explained = Faults of instruments are excluded, and nothing else is altered. Untick what is to be restored, or name a range of time, which two clicks on a plot below fill in; then check again.
excluded-exclude = Exclude
excluded-values = Values and reason
excluded-rows = Rows of the file
excluded-one = Exclude { $summary }
excluded-nothing = Nothing is excluded.
excluded-channel = Channel
excluded-whole-rows = all: whole rows
excluded-from = From [s]
excluded-to = To [s]
excluded-range = Exclude range
excluded-restore = Restore range

## Templates

templates-heading = Templates
templates-explained = Keep how the columns are read, with your corrections, for the next files of this form.
templates-for = For
templates-this-ship = this ship
templates-server = all ships of the server
templates-of-server = { $name } (server)
templates-keep = Keep template
templates-kept = Kept templates
templates-choose = choose
templates-use = Use
templates-remove = Remove
templates-removed = was removed; choose another

## Previews

preview-heading = Files with these settings
preview-samples = { $rows } samples over { $duration }.
preview-row = row { $row },
preview-remarks = { $count ->
        [one] 1 remark
       *[other] { $count } remarks
    }
preview-track = Track of { $name }
preview-channels = Channels of { $name } over time; what is excluded is shaded
preview-manifest = The manifest, for the command line

## After the upload

stored-title = Trials of { $ship } are stored
stored-heading = { $count ->
        [one] 1 trial is stored
       *[other] { $count } trials are stored
    }
stored-diagnosed = The champion is being diagnosed on the new trials: <a href="{ $address }">progress and result</a>.
stored-next = Next step: a refinement fits a model to all trials of the ship. With the default settings all sources, laws and methods are compared by their errors on held-out manoeuvres.
stored-further = Upload further trials
stored-other = Other settings, and all trials of the ship

## Errors

upload-read-already = `{ $column }` is read as { $channel } already; choose one column
upload-no-channel = `{ $channel }` is not a channel; choose one of the list
upload-one-of = must be { $one } or { $other }
upload-missing-values = must be bridge, drop or refuse
upload-time-empty = is empty; enter a time in seconds
upload-not-a-file = is not a file of this upload
upload-not-read = `{ $channel }` is not read from these files; choose one of the list
upload-no-rows = is not after the start, or there is no row between them
upload-nothing-excluded = nothing is excluded in this range
upload-choose-template = choose one of the list
upload-listed-twice = is listed twice, or there are too many files
upload-file-names = choose files with names of 1 to 200 bytes
upload-cannot-read = a file cannot be read; see its errors below
upload-expired = this upload has expired or was stored already; choose the files again

## Fields of a trial

mapping-depth-heading = Depth
mapping-depth-unit = m, empty for deep water
mapping-depth-label = Depth, m
mapping-revolutions = Revolutions
mapping-revolutions-unit = rpm, where none are recorded
mapping-revolutions-label = Revolutions, rpm
mapping-revolutions-of = Revolutions of { $file }, rpm
mapping-current = Current
mapping-current-unit = kn, subtracted
mapping-current-label = Current, kn
mapping-current-of = Current of { $file }, kn
mapping-towards = Flows towards
mapping-towards-unit = deg
mapping-towards-label = Flows towards, deg
mapping-towards-of = Direction of the current of { $file }, deg
upload-positive-depth = must be above 0; leave it empty for deep water
upload-positive-revolutions = must be above 0; leave it empty where the file records them
