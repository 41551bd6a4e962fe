## Schiffsangaben

particular-lpp-m = Länge zwischen den Loten
particular-loa-m = Länge über alles
particular-beam-m = Breite
particular-draught-m = Tiefgang
particular-draught-m-hint = Mittschiffs, während der Versuche
particular-displacement-m3 = Verdrängung
particular-displacement-m3-hint = Volumen
particular-service-speed-m-s = Dienstgeschwindigkeit
particular-service-speed-m-s-hint = Oder in Knoten, als 20 kn
particular-draught-fore-m = Tiefgang vorn
particular-draught-aft-m = Tiefgang achtern
particular-block-coefficient = Blockkoeffizient
particular-x-g-m = Schwerpunkt vor mittschiffs
particular-yaw-gyradius-ratio = Trägheitsradius um die Hochachse
particular-yaw-gyradius-ratio-hint = Geteilt durch die Länge
particular-roll-gyradius-ratio = Trägheitsradius um die Längsachse, geteilt durch die Breite
particular-rudder-area-m2 = Ruderfläche
particular-rudder-height-m = Ruderhöhe
particular-rudder-aspect-ratio = Seitenverhältnis des Ruders
particular-propeller-diameter-m = Propellerdurchmesser
particular-propeller-blades = Propellerflügel
particular-propeller-pitch-ratio = Steigungsverhältnis des Propellers
particular-gm-m = Metazentrische Höhe GM
particular-kg-m = Höhe des Schwerpunkts KG
particular-km-m = Höhe des Metazentrums KM
particular-kb-m = Höhe des Auftriebsschwerpunkts KB
particular-depth-moulded-m = Seitenhöhe
particular-mass-kg = Masse
particular-water-density-kg-m3 = Dichte des Wassers
particular-frontal-area-m2 = Frontfläche über Wasser
particular-lateral-area-m2 = Lateralfläche über Wasser

## Formular der Schiffsangaben

new-ship-heading = Schiff hinzufügen
new-ship-explained = Die Hauptabmessungen genügen für den Anfang: Mit ihnen werden ähnliche veröffentlichte Schiffe gefunden. Das erste Modell entsteht durch eine Verfeinerung an den Versuchen.
new-ship-ship = Das Schiff
new-ship-name-hint = Wie es bekannt ist, zum Beispiel M/V Anna
new-ship-short-name = Kurzname für Adressen (optional)
new-ship-short-name-hint = Kleinbuchstaben, Ziffern und Bindestriche, zum Beispiel anna; sonst aus dem Namen gebildet. Später nicht änderbar.
new-ship-category-hint = Schiffe werden innerhalb einer Gruppe von Kategorien verglichen, zum Beispiel tanker oder dry-cargo
new-ship-source = Quelle der Zahlen
new-ship-source-hint = Zum Beispiel Generalplan, Trimm- und Stabilitätsunterlagen
new-ship-dimensions = Hauptabmessungen
new-ship-further = Weitere Schiffsangaben, soweit bekannt
new-ship-by-program = Ein Programm sendet stattdessen eine Schiffsdatei mit Modellen an <code>POST /v1/ships</code>.
particulars-title = Schiffsangaben von { $ship }
particulars-explained = Vorhandene Versionen behalten die Angaben, mit denen sie entstanden; die nächste Verfeinerung nimmt diese. Eine geänderte Zahl hat die unten genannte Quelle.
particulars-further = Weitere Schiffsangaben
particulars-source = Quelle der geänderten Zahlen
particulars-source-hint = Zum Beispiel Tiefgangsaufnahme vom 28. November 2026
particulars-save = Schiffsangaben speichern

## Kenngrößen von Manövern

figure-advance = Längsversetzung (Advance)
figure-transfer = Querversetzung (Transfer)
figure-tactical-diameter = taktischer Drehkreisdurchmesser
figure-steady-radius = stationärer Drehkreisradius
figure-steady-turning-radius = stationärer Drehkreisradius
figure-speed-loss = Geschwindigkeitsverlust
figure-first-overshoot = erster Überschwingwinkel
figure-second-overshoot = zweiter Überschwingwinkel
figure-period = Periode
figure-initial-turning = Anschwenkweg
figure-initial-turning-time = Anschwenkzeit
figure-of-turn = Drehkreis { $rudder }°: { $figure }
figure-of-zigzag = Z-Manöver { $angles }: { $figure }

## Kriterien von MSC.137(76)

criterion-advance = Längsversetzung (Advance)
criterion-tactical-diameter = taktischer Drehkreisdurchmesser
criterion-initial-turning-ability = Anschwenkvermögen
criterion-10-10-first-overshoot = erster Überschwingwinkel 10/10
criterion-10-10-second-overshoot = zweiter Überschwingwinkel 10/10
criterion-20-20-first-overshoot = erster Überschwingwinkel 20/20

## Aufgezeichnete Größen

variable-u = Längsgeschwindigkeit
variable-v = Quergeschwindigkeit
variable-r = Giergeschwindigkeit
variable-psi = Steuerkurs
variable-x = Position Nord
variable-y = Position Ost
variable-position = Position
variable-phi = Rollwinkel
variable-p = Rollgeschwindigkeit
variable-delta = Ruderlage
variable-n = Propellerdrehzahl
variable-wind-speed = Windgeschwindigkeit
variable-wind-from = Windrichtung
variable-apparent-wind-speed = scheinbare Windgeschwindigkeit
variable-apparent-wind-from = scheinbarer Wind vom Bug aus
variable-depth = Wassertiefe
variable-time = Zeit
variable-t = Zeit
axis-X = Längskraft X
axis-Y = Querkraft Y
axis-K = Rollmoment K
axis-N = Giermoment N
axis-parameters = Parameter der Modellstruktur
axis-other = weitere
new-ship-add = Schiff hinzufügen

## Einheiten

unit-deg = °
unit-deg-s = °/s
