## Zustand und nächster Schritt

ship-family = Familie
ship-condition = Zustand
ship-since = Das gilt seit dem Versuch { $trial }, hochgeladen { $at }.
ship-diagnosis-report = Bericht der Diagnose
ship-with-effects = <a href="{ $address }">Version { $number }</a> ist das Modell mit den fehlenden Effekten; bei Zustimmung kann sie unten eingesetzt werden.
ship-based-on = Auf Grundlage von { $count } Diagnosen
ship-all-trials = alle Versuche: { $trials }
verdict-complete = vollständig
verdict-effects = Effekte
verdict-unexplained = unerklärt
verdict-drift = Modelldrift
condition-no-champion = Unbekannt: Es gibt noch keine aktive Version.
condition-not-diagnosed = Unbekannt: Die aktive Version wurde noch auf keinem Versuch diagnostiziert.
condition-holds = Das Modell gilt: Auf { $trials } entspricht das Residuum dem Rauschen.
condition-count-trials = { $count ->
        [one] 1 Versuch
       *[other] { $count } Versuchen
    }
condition-fails = Das Modell gilt nicht: { $evidence }.
condition-fails-since = Das Modell gilt seit dem Versuch { $since } nicht: { $evidence }.
condition-some-trials = { $against } von { $all }
condition-lacks = auf { $trials } fehlt { $effects }
condition-lacks-more = auf { $trials } fehlt { $effects } sowie etwas, das kein bekannter Effekt erklärt
condition-unexplained = auf { $trials } fehlt etwas, das kein bekannter Effekt erklärt
condition-drifted = die unerklärte Kraft ist auf neuen Versuchen { $ratio }-mal so groß wie auf den angepassten (Achse { $axis })
next-label = Nächster Schritt
next-job-runs = Ein Auftrag zu diesem Schiff läuft ({ $kind }): { $percent } %.
next-see-progress = Fortschritt ansehen
next-no-trials = Das Schiff hat noch keine Versuche. Drehkreise und Z-Manöver sagen am meisten.
next-upload = Versuche hochladen
next-not-refined = Das Schiff hat Versuche, aber kein daran angepasstes Modell.
next-refine = Modell verfeinern
next-has-effects = Version { $number } hat die fehlenden Effekte.
next-look-at-version = Version { $number } ansehen
next-none-in-use = Noch ist keine Version aktiv.
next-look-at-newest = Neueste Version ansehen
next-newer = Version { $number } ist aktiv, und es gibt eine neuere.
next-compare = Beide vergleichen
next-not-diagnosed = Version { $number } wurde nicht diagnostiziert, seit sie aktiv ist.
next-diagnose = Diagnostizieren
next-has-report = Version { $number } ist aktiv. Ihr Bericht enthält das Urteil.
next-look-at-report = Bericht ansehen
next-in-use = Version { $number } ist aktiv.
next-look-at-it = Ansehen

## Aktionen

actions-heading = Weitere Aktionen: hochladen, verfeinern, diagnostizieren, einsetzen, Schlagwörter, Notizen
action-upload-explained = CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 oder 2000; der Kanal jeder Spalte wird gezeigt und kann korrigiert werden, bevor die Versuche gespeichert werden.
action-choose-files = Dateien wählen
action-refine = Verfeinern
action-refine-explained = Passt ein Modell an alle Versuche des Schiffes an. Mit den Standardeinstellungen werden alle Quellen, Modellstrukturen und Verfahren nach ihren Fehlern auf zurückgehaltenen Manövern verglichen.
method-select = alle vergleichen und das beste wählen
method-weak = weak: Gleichungen über Fenster integriert
method-trajectory = trajectory: kleinste Quadrate auf simulierten Abschnitten
method-published = published: Einschrittdifferenzen
method-cma-es = cma-es: evolutionäre Suche auf Simulationen
action-diagnose = Diagnostizieren
action-diagnose-explained = Prüft auf Versuchen, an die eine Version nicht angepasst wurde, ob sie die Bewegung des Schiffes noch beschreibt, und findet sonst die fehlenden Effekte.
action-promote = Einsetzen oder zurücknehmen
action-promote-explained = Der Champion ist die aktive Version. Hat ein anderer Benutzer sie seit dem Laden dieser Seite geändert, wird die Anfrage abgelehnt. Jede Änderung wird mit ihrer Begründung festgehalten.
action-champion-mark = (aktiv)
action-make-champion = Als aktive Version einsetzen
action-roll-back = Zurück zu Version { $number }
action-roll-back-reason = auf der Seite des Schiffes zurückgenommen
action-tags = Schlagwörter
action-remove-tag = Schlagwort { $tag } entfernen
action-remove = entfernen
action-new-tag = Neues Schlagwort
action-add-tag = Schlagwort hinzufügen
action-note = Notiz
action-note-explained = Hinweise für andere Benutzer, etwa Arbeiten am Rumpf. Notizen sind nicht änderbar und nennen ihren Verfasser.
action-add-note = Notiz hinzufügen

## Versionen und Versuche

ship-versions = Versionen des Modells
ship-aliases = Aliase
ship-made-from = Entstanden aus
ship-by = Von
ship-mark-version = Version { $number } auswählen
ship-report-link = Bericht
ship-no-versions = Noch keine: Versuche hochladen und verfeinern.
ship-compare-marked = Ausgewählte Versionen vergleichen
ship-all-versions = Alle Versionen als JSON
ship-compare-newest = Die beiden neuesten vergleichen
ship-simulate = Aktive Version simulieren
ship-champion-yaml = Aktive Version als YAML
ship-state-conditions = Datum, Ort, Wetter und Beladung angeben
ship-all-trials-json = Alle Versuche als JSON
ship-notes = Notizen
ship-all-notes = Alle Notizen als JSON

## Schiffsangaben und ähnliche Schiffe

ship-particulars = Schiffsangaben
ship-change-particulars = Schiffsangaben ändern
ship-revision = Revision { $number } des Schiffsdokuments
ship-particular = Angabe
ship-drawing-explained = Maßstäblich: Länge, Breite, Tiefgang, Seitenhöhe, Ruder und Propeller wie angegeben. Die Rumpflinien sind schematisch.
drawing-label = { $title }, maßstäblich: Länge { $length } m, Breite { $beam } m
drawing-midship = mittschiffs, Breite { $beam } m
drawing-gravity = G { $distance } m von mittschiffs
drawing-draught = Tiefgang { $draught } m
drawing-rudder = Ruder { $area } m²
drawing-propeller = Propellerdurchmesser { $diameter } m
ship-similar = Ähnliche Schiffe
ship-eligible = Als Quelle geeignet
ship-reasons = Gründe
ship-none-comparable = Kein anderes Schiff ist vergleichbar.
ship-all-by-similarity = Alle Schiffe nach Ähnlichkeit
ship-ranking-json = Rangfolge, die auch die Versuche nutzt, als JSON
