## Diagrammer

plot-track = Bane: { $label }
plot-over-time = Over tid: { $label }
plot-time = tid [s]
plot-start = start
plot-north = x nord [m] ↑
plot-east = y øst [m] →
plot-turns = Svingesirkler, 35°
plot-zigzag = Sikksakkprøve 20/20
plot-turn-starboard = svingesirkel, 35° mot styrbord
plot-turn-port = svingesirkel, 35° mot babord
plot-zigzag-line = sikksakk 20/20

## Kanaler

channel-u = langskips hastighet u
channel-v = tverrskips hastighet v
channel-r = girhastighet r
channel-psi = kurs ψ
channel-phi = rullevinkel φ
channel-delta = rorvinkel δ
channel-n = turtall n
channel-wind-speed = sann vindhastighet
channel-wind-from = sann vind fra
channel-depth = vanndybde
channel-x = posisjon nord x
channel-y = posisjon øst y
channel-p = rullehastighet p
channel-u-water = langskips hastighet gjennom vannet
channel-v-water = tverrskips hastighet gjennom vannet
channel-delta-s = styrbord ror
channel-delta-p = babord ror
channel-n-s = styrbord turtall
channel-n-p = babord turtall

## Ord fra skriptet for diagrammer

chart-script-toggle = Vis eller skjul
chart-script-play = Spill av
chart-script-pause = Pause
chart-script-play-title = Flytt skipet langs banen
chart-script-time = Tid
chart-script-zoom-in = Forstørr
chart-script-zoom-in-title = Forstørr rundt markøren; eller dra i et diagram
chart-script-zoom-out = Forminsk
chart-script-reset = Nullstill
chart-script-reset-title = Vis alt; eller dobbeltklikk i et diagram
chart-script-full-screen = Fullskjerm
chart-script-full-screen-title = Fullskjerm; Escape avslutter
chart-script-csv = Last ned verdiene for de tegnede linjene
chart-script-svg = Last ned som vektorgrafikk
chart-script-png = Last ned som bilde
chart-script-values = Verdier ved markøren
chart-script-cursor = Ved markøren
chart-script-north = x nord [m]
chart-script-east = y øst [m]
