## Diagramme

plot-track = Bahn: { $label }
plot-over-time = Über die Zeit: { $label }
plot-time = Zeit [s]
plot-start = Start
plot-north = x Nord [m] ↑
plot-east = y Ost [m] →
plot-turns = Drehkreise, 35°
plot-zigzag = Z-Manöver 20/20
plot-turn-starboard = Drehkreis, 35° nach Steuerbord
plot-turn-port = Drehkreis, 35° nach Backbord
plot-zigzag-line = Z-Manöver 20/20

## Kanäle

channel-u = Längsgeschwindigkeit u
channel-v = Quergeschwindigkeit v
channel-r = Giergeschwindigkeit r
channel-psi = Steuerkurs ψ
channel-phi = Rollwinkel φ
channel-delta = Ruderlage δ
channel-n = Drehzahl n
channel-wind-speed = wahre Windgeschwindigkeit
channel-wind-from = wahrer Wind aus
channel-depth = Wassertiefe
channel-x = Position Nord x
channel-y = Position Ost y
channel-p = Rollgeschwindigkeit p
channel-u-water = Längsgeschwindigkeit durchs Wasser
channel-v-water = Quergeschwindigkeit durchs Wasser
channel-delta-s = Ruderlage Steuerbord
channel-delta-p = Ruderlage Backbord
channel-n-s = Drehzahl Steuerbord
channel-n-p = Drehzahl Backbord

## Wörter des Skripts der Diagramme

chart-script-toggle = Zeigen oder verbergen
chart-script-play = Abspielen
chart-script-pause = Pause
chart-script-play-title = Das Schiff entlang seiner Bahn bewegen
chart-script-time = Zeit
chart-script-zoom-in = Vergrößern
chart-script-zoom-in-title = Um den Zeiger vergrößern; oder im Diagramm ziehen
chart-script-zoom-out = Verkleinern
chart-script-reset = Zurücksetzen
chart-script-reset-title = Alles zeigen; oder im Diagramm doppelklicken
chart-script-full-screen = Vollbild
chart-script-full-screen-title = Vollbild; Escape beendet es
chart-script-csv = Werte der gezeichneten Linien herunterladen
chart-script-svg = Als Vektorgrafik herunterladen
chart-script-png = Als Bild herunterladen
chart-script-values = Werte am Zeiger
chart-script-cursor = Am Zeiger
chart-script-north = x Nord [m]
chart-script-east = y Ost [m]
