## Überschriften und Sammlungen

fleet-title = Flotte
fleet-collections = Sammlungen
fleet-own = Eigene Flotte
fleet-library = Bibliothek
fleet-library-heading = Bibliothek veröffentlichter Schiffe
fleet-all = Alle Schiffe
fleet-add = Schiff hinzufügen
fleet-library-explained = Veröffentlichte Schiffe, die das Programm mitbringt: Quellen von Verfeinerungen und Beispiele. Ein Schiff mit eigenen Versuchen gehört zur eigenen Flotte.
fleet-changing = Einige Schiffe wurden eben geändert; diese Reihenfolge wird in Sekunden aktualisiert.

## Erste Schritte

steps-label = Erste Schritte
step-state-done = erledigt
step-state-next = jetzt
step-state-later = später
step-add-title = Schiff hinzufügen
step-add-text = Länge, Breite, Tiefgang und Verdrängung genügen für den Anfang.
step-upload-title = Versuche hochladen
step-upload-text = Drehkreise und Z-Manöver, wie aufgezeichnet; die Spalten werden erkannt.
step-refine-title = Modell verfeinern
step-refine-text = Das Modell des ähnlichsten Schiffes wird an die Versuche angepasst und an Manövern beurteilt, die es nicht kennt.
steps-looking = Nur zum Umsehen?
steps-example = Beispiel laden
steps-example-explained = fügt ein Containerschiff von 175 m mit acht simulierten Versuchen hinzu, bereit zur Verfeinerung

## Übersicht

board-counts = Schiffe nach Zustand
board-worst = Brauchen zuerst Aufmerksamkeit
board-recent = In dieser Woche geändert
board-drift = Modelldrift der Flotte
board-drift-explained = Unerklärte Kraft auf neuen Versuchen geteilt durch die auf den angepassten: Median der Diagnosen jeder Woche mit ihrer Anzahl. Über der Linie ist ein Modell zweifelhaft.
board-drift-label = Median der Modelldrift der Diagnosen jeder Woche, { $last } in der letzten; über { $limit } ist ein Modell zweifelhaft
board-today = heute
board-unexplained = etwas Unerklärtes
change-diagnosed-complete = eine Diagnose fand, dass nichts fehlt
change-diagnosed-effects = eine Diagnose fand einen fehlenden Effekt
change-diagnosed-other = eine Diagnose fand einen unerklärten Rest
change-promoted = Version { $number } wurde aktiv
change-made = Version { $number } entstand
change-uploaded = { $count ->
        [one] 1 Versuch wurde hochgeladen
       *[other] { $count } Versuche wurden hochgeladen
    }
change-added = das Schiff wurde hinzugefügt

## Zustand

condition-class-does-not-hold = gilt nicht
condition-class-unknown = nicht diagnostiziert
condition-class-no-model = kein Modell
condition-class-holds = gilt
condition-drift = Modelldrift
condition-drift-times = Modelldrift, { $ratio }-fach

## Suche

search-heading = Suchen und ordnen
search-all-ships = alle
search-own = eigene Flotte
search-library = Bibliothek
search-condition = Zustand
search-order = Reihenfolge
search-order-worst = schlechteste zuerst
search-order-name = Name
search-order-value = Wert der Schiffsangabe oder Kenngröße
search-from = Namen ab (Reihenfolge nach Namen)
search-further = Nach Kategorie, Schlagwort, Schiffsangaben, Manövern und Ähnlichkeit suchen
search-tag = Schlagwort
search-similar = Am ähnlichsten dem Schiff
search-particular = Eine Schiffsangabe, SI
search-least = Mindestens
search-most = Höchstens
search-figure-legend = Eine Kenngröße der Standardmanöver der aktiven Version, die größere beider Seiten
search-figure = Kenngröße
search-correlation = Korrelation
search-wrong-order = worst, name oder value wählen, nicht „{ $text }“
search-order-by-name = die Reihenfolge nach Namen geht nur ohne Zustand, Schiffsangabe und Kenngröße; nach Wert oder die schlechtesten zuerst ordnen
search-order-by-value = die Reihenfolge nach Wert braucht einen Bereich einer Schiffsangabe oder Kenngröße
search-no-class = es gibt kein „{ $name }“

## Liste

fleet-none-own = Noch kein eigenes Schiff. Die <a href="/?ships=library">Bibliothek veröffentlichter Schiffe</a> kann angesehen, verglichen und simuliert werden.
fleet-compare-marked = Ausgewählte Schiffe vergleichen
fleet-compare-hint = zwei bis fünf, jedes mit der aktiven Version
fleet-mark-ship = { $ship } auswählen
fleet-in-use = Aktiv
fleet-unexplained = Unerklärte Kraft
fleet-no-match = Kein Schiff passt.
fleet-further = Weitere Schiffe
fleet-spark = Unerklärte Kraft von { $count } Versuchen über die Zeit, { $last } % im letzten

## Bedeutung der Spalten

columns-heading = Was die Spalten bedeuten
columns-in-use = die aktive Version des Schiffes, der Champion
columns-holds-name = Gilt
columns-holds = das Residuum der aktiven Version auf den neuesten Versuchen entspricht dem Rauschen
columns-does-not-hold-name = Gilt nicht
columns-does-not-hold = ein Effekt fehlt; er wird genannt, wenn die Bibliothek einen hat, der das Residuum erklärt
columns-unknown-name = Nicht diagnostiziert
columns-unknown = die aktive Version wurde noch nicht diagnostiziert
columns-error = mittlerer quadratischer Fehler simulierter, zurückgehaltener Manöver, geteilt durch die Varianz der Messung: 0 ist perfekt, 1 nicht besser als der Mittelwert
columns-force = unerklärte Kraft in jedem der neuesten 24 Versuche, der älteste zuerst; jede Linie hat ihren eigenen Maßstab

## Karte

map-heading = Wo die Schiffe sind
map-explained = Letzte bekannte Positionen: die der neuesten Versuche mit Breite und Länge. <span class="state does-not-hold">Kreuz: gilt nicht</span> · Dreieck: nicht diagnostiziert · Quadrat: kein Modell · <span class="good">Kreis: gilt</span>.
map-most-urgent = Gezeigt sind die { $shown } dringendsten von { $placed } Schiffen.
map-source = Küstenlinien: Natural Earth.
map-table = Positionen als Tabelle
map-positions = Positionen
map-position = Position
map-label = Karte der Schiffe; die Tabelle unten hat denselben Inhalt
map-mark = { $ship }: { $condition }
map-direction-N = N
map-direction-S = S
map-direction-E = O
map-direction-W = W
