## Particulars

particular-lpp-m = Length between perpendiculars
particular-loa-m = Length over all
particular-beam-m = Beam
particular-draught-m = Draught
particular-draught-m-hint = At midship, in the trials
particular-displacement-m3 = Displacement
particular-displacement-m3-hint = Volume
particular-service-speed-m-s = Service speed
particular-service-speed-m-s-hint = Or in knots, as 20 kn
particular-draught-fore-m = Draught fore
particular-draught-aft-m = Draught aft
particular-block-coefficient = Block coefficient
particular-x-g-m = Centre of gravity ahead of midship
particular-yaw-gyradius-ratio = Yaw radius of gyration
particular-yaw-gyradius-ratio-hint = Divided by the length
particular-roll-gyradius-ratio = Roll radius of gyration, divided by the beam
particular-rudder-area-m2 = Rudder area
particular-rudder-height-m = Rudder height
particular-rudder-aspect-ratio = Rudder aspect ratio
particular-propeller-diameter-m = Propeller diameter
particular-propeller-blades = Propeller blades
particular-propeller-pitch-ratio = Propeller pitch ratio
particular-gm-m = Metacentric height GM
particular-kg-m = Height of the centre of gravity KG
particular-km-m = Height of the metacentre KM
particular-kb-m = Height of the centre of buoyancy KB
particular-depth-moulded-m = Moulded depth
particular-mass-kg = Mass
particular-water-density-kg-m3 = Density of water
particular-frontal-area-m2 = Frontal area above water
particular-lateral-area-m2 = Lateral area above water

## Form of the particulars

new-ship-heading = Add a ship
new-ship-explained = Main dimensions are enough to begin with: the published ships that resemble yours are found by them. Its first model is made by a refinement on its trials.
new-ship-ship = The ship
new-ship-name-hint = As people know it, for example M/V Anna
new-ship-short-name = Short name for addresses (optional)
new-ship-short-name-hint = Lower-case letters, digits and hyphens, for example anna; by default made of the name. It cannot be changed later.
new-ship-category-hint = Ships are compared within a group of categories, for example tanker or dry-cargo
new-ship-source = Source of the figures
new-ship-source-hint = For example general arrangement plan, trim and stability booklet
new-ship-dimensions = Main dimensions
new-ship-further = Further particulars, if you know them
new-ship-by-program = A program sends a vessel file with models to <code>POST /v1/ships</code> instead.
particulars-title = Particulars of { $ship }
particulars-explained = Versions that exist keep the particulars they were made with; the next refinement takes these. A changed figure has the source that you name below.
particulars-further = Further particulars
particulars-source = Source of the changed figures
particulars-source-hint = For example draught survey of 28 November 2026
particulars-save = Save the particulars

## Figures of manoeuvres

figure-advance = advance
figure-transfer = transfer
figure-tactical-diameter = tactical diameter
figure-steady-radius = steady radius
figure-steady-turning-radius = steady turning radius
figure-speed-loss = speed loss
figure-first-overshoot = first overshoot
figure-second-overshoot = second overshoot
figure-period = period
figure-initial-turning = initial turning
figure-initial-turning-time = initial turning time
figure-of-turn = turn { $rudder } deg: { $figure }
figure-of-zigzag = zigzag { $angles }: { $figure }

## Criteria of MSC.137(76)

criterion-advance = advance
criterion-tactical-diameter = tactical diameter
criterion-initial-turning-ability = initial turning ability
criterion-10-10-first-overshoot = 10/10 first overshoot
criterion-10-10-second-overshoot = 10/10 second overshoot
criterion-20-20-first-overshoot = 20/20 first overshoot

## Recorded variables

variable-u = surge speed
variable-v = sway speed
variable-r = yaw rate
variable-psi = heading
variable-x = position north
variable-y = position east
variable-position = position
variable-phi = roll angle
variable-p = roll rate
variable-delta = rudder angle
variable-n = propeller revolutions
variable-wind-speed = wind speed
variable-wind-from = direction the wind comes from
variable-apparent-wind-speed = apparent wind speed
variable-apparent-wind-from = apparent wind from the bow
variable-depth = water depth
variable-time = time
variable-t = time
axis-X = surge force X
axis-Y = sway force Y
axis-K = roll moment K
axis-N = yaw moment N
axis-parameters = parameters of the law
axis-other = other
new-ship-add = Add the ship

## Units

unit-deg = deg
unit-deg-s = deg/s
