## Plots

plot-track = Track: { $label }
plot-over-time = Over time: { $label }
plot-time = time [s]
plot-start = start
plot-north = x north [m] ↑
plot-east = y east [m] →
plot-turns = Turning circles, 35 deg
plot-zigzag = Zigzag 20/20
plot-turn-starboard = turn, 35 deg to starboard
plot-turn-port = turn, 35 deg to port
plot-zigzag-line = zigzag 20/20

## Panels of channels

channel-u = surge speed u
channel-v = sway speed v
channel-r = yaw rate r
channel-psi = heading ψ
channel-phi = roll φ
channel-delta = rudder δ
channel-n = revolutions n
channel-wind-speed = true wind speed
channel-wind-from = true wind from
channel-depth = water depth
channel-x = position north x
channel-y = position east y
channel-p = roll rate p
channel-u-water = surge speed through water
channel-v-water = sway speed through water
channel-delta-s = starboard rudder
channel-delta-p = port rudder
channel-n-s = starboard revolutions
channel-n-p = port revolutions

## Words that the script of charts writes; the English ones stand in chart.js as well

chart-script-toggle = Show or hide
chart-script-play = Play
chart-script-pause = Pause
chart-script-play-title = Move the ship along its track
chart-script-time = Time
chart-script-zoom-in = Zoom in
chart-script-zoom-in-title = Zoom in around the cursor; or drag in a panel
chart-script-zoom-out = Zoom out
chart-script-reset = Reset
chart-script-reset-title = Show everything; or double-click in a panel
chart-script-full-screen = Full screen
chart-script-full-screen-title = Full screen; Escape leaves it
chart-script-csv = Download the values of the drawn lines
chart-script-svg = Download as vector graphics
chart-script-png = Download as an image
chart-script-values = Values at the cursor
chart-script-cursor = At the cursor
chart-script-north = x north [m]
chart-script-east = y east [m]
