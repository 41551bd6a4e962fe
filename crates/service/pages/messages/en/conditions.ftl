conditions-title = Conditions of the trials of { $ship }
conditions-heading = Conditions of the trials
conditions-explained = The acceptance summary states these, and no instrument records them. Leave open what you do not know. Each statement is kept with its author and time; the latest one counts.
conditions-no-trials = The ship has no trials yet. <a href="{ $address }">Upload trials</a> first.
conditions-trials = Trials with these conditions
conditions-stated-for = stated for { $date }
conditions-legend = Conditions
conditions-save = Save the conditions
conditions-choose-trials = choose the trials with these conditions

## Fields

stated-date = Date of the trials
stated-place = Place
stated-place-hint = For example Skagerrak, 57.9 N 9.8 E
stated-wind = Wind
stated-wind-hint = For example 6 m/s from south-west, Beaufort 4
stated-sea = Sea and swell
stated-sea-hint = For example significant height 0.5 m, sea state 2
stated-depth = Water depth
stated-depth-hint = For example 180 m, or deep
stated-draught-fore-m = Draught fore, m
stated-draught-aft-m = Draught aft, m
stated-displacement = Displacement during the trials
stated-displacement-hint = For example 21 800 t
stated-instruments = Instruments
stated-instruments-hint = For example DGPS, gyro compass, Doppler log
stated-remarks = Remarks
stated-remarks-hint = For example ballast condition, hull cleaned in May
