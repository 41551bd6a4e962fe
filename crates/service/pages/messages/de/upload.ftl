## Dateien werden gewählt

upload-title = Versuche von { $ship } hochladen
upload-explained = Dateien eines oder mehrerer Versuche wählen: CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 oder 2000. Dateien mit gleichen Spalten sind getrennte Versuche; eine Datei mit anderen Spalten wird als weiterer Sensor des Versuchs mit dem ähnlichsten Namen gelesen. Die nächste Seite zeigt den Kanal jeder Spalte und eine Vorschau; gespeichert wird erst nach einer Bestätigung.
upload-files = Dateien
upload-preview = Vorschau

## Lesart der Spalten

mapping-title = Prüfung der Dateien für { $ship }
mapping-kicker = hochladen
mapping-heading = Dateien prüfen
mapping-accepted = <strong>Alle Dateien sind lesbar.</strong> Bitte die markierten Spalten prüfen, bei Bedarf korrigieren und die Versuche speichern.
mapping-refused = <strong>Einige Dateien sind noch nicht lesbar.</strong> Die Fehler stehen unter jeder Datei. Bitte die Spalten korrigieren und erneut prüfen.
mapping-offer = { $file } hat dieselben Spalten wie die Vorlage <strong>{ $template }</strong>.
mapping-use-offer = Diese Vorlage verwenden
mapping-by-template = Die Spalten werden nach der Vorlage <strong>{ $template }</strong> gelesen.
mapping-columns = Spalten
mapping-column = Spalte
mapping-read-as = Gelesen als
mapping-sign = Vorzeichen
mapping-confidence = Sicherheit
mapping-over-99 = über 99 %
mapping-why = Warum
mapping-channel-of = Kanal von { $column }
mapping-ignored = nicht gelesen
mapping-unit-of = Einheit von { $column }
mapping-reverse = Vorzeichen von { $column } umkehren
mapping-reversed = umgekehrt
mapping-check = prüfen:
mapping-given = auf dieser Seite angegeben
mapping-signs = Vorzeichen und Bezugssysteme
mapping-rudder = Positive Ruderlage
mapping-rudder-starboard = dreht das Schiff nach Steuerbord
mapping-rudder-port = dreht es nach Backbord
mapping-velocity = u und v sind Geschwindigkeiten
mapping-velocity-ground = über Grund
mapping-velocity-water = durchs Wasser
mapping-missing = Zeilen mit fehlendem Wert
mapping-missing-bridge = werden gefüllt, wo die Lücke kurz ist
mapping-missing-drop = werden ausgelassen
mapping-missing-refuse = führen zur Ablehnung der Datei
mapping-derive = Aus Bahn und Steuerkurs ableiten
mapping-file = Datei
mapping-manoeuvre-of = Manöver von { $file }
mapping-manoeuvre-example = Z-Manöver 10/10
mapping-depth-of = Wassertiefe von { $file }
mapping-diagnose = Die aktive Version auf den neuen Versuchen diagnostizieren
mapping-check-again = Erneut prüfen
mapping-store = Versuche speichern

## Ausschlüsse

excluded-heading = Ausgeschlossene Werte
excluded-explained = Fehler von Instrumenten sind ausgeschlossen, sonst ist nichts verändert. Was wieder gelten soll, abwählen, oder einen Zeitbereich angeben, den zwei Klicks in ein Diagramm unten eintragen; dann erneut prüfen.
excluded-exclude = Ausschließen
excluded-values = Werte und Grund
excluded-rows = Zeilen der Datei
excluded-one = { $summary } ausschließen
excluded-nothing = Nichts ist ausgeschlossen.
excluded-channel = Kanal
excluded-whole-rows = alle: ganze Zeilen
excluded-from = Von [s]
excluded-to = Bis [s]
excluded-range = Bereich ausschließen
excluded-restore = Bereich wiederherstellen

## Vorlagen

templates-heading = Vorlagen
templates-explained = Die Lesart der Spalten mit den Korrekturen für die nächsten Dateien dieser Form aufbewahren.
templates-for = Für
templates-this-ship = dieses Schiff
templates-server = alle Schiffe des Servers
templates-of-server = { $name } (Server)
templates-keep = Vorlage aufbewahren
templates-kept = Aufbewahrte Vorlagen
templates-choose = wählen
templates-use = Verwenden
templates-remove = Entfernen
templates-removed = wurde entfernt; bitte eine andere wählen

## Vorschau

preview-heading = Dateien mit diesen Einstellungen
preview-samples = { $rows } Messpunkte über { $duration }.
preview-row = Zeile { $row },
preview-remarks = { $count ->
        [one] 1 Hinweis
       *[other] { $count } Hinweise
    }
preview-track = Bahn von { $name }
preview-channels = Kanäle von { $name } über die Zeit; Ausgeschlossenes ist schattiert
preview-manifest = Das Manifest für die Befehlszeile

## Nach dem Hochladen

stored-title = Versuche von { $ship } sind gespeichert
stored-heading = { $count ->
        [one] 1 Versuch ist gespeichert
       *[other] { $count } Versuche sind gespeichert
    }
stored-diagnosed = Die aktive Version wird auf den neuen Versuchen diagnostiziert: <a href="{ $address }">Fortschritt und Ergebnis</a>.
stored-next = Nächster Schritt: Eine Verfeinerung passt ein Modell an alle Versuche des Schiffes an. Mit den Standardeinstellungen werden alle Quellen, Modellstrukturen und Verfahren nach ihren Fehlern auf zurückgehaltenen Manövern verglichen.
stored-further = Weitere Versuche hochladen
stored-other = Andere Einstellungen und alle Versuche des Schiffes

## Fehler

upload-read-already = „{ $column }“ wird schon als { $channel } gelesen; bitte eine Spalte wählen
upload-no-channel = „{ $channel }“ ist kein Kanal; bitte einen der Liste wählen
upload-one-of = muss { $one } oder { $other } sein
upload-missing-values = muss bridge, drop oder refuse sein
upload-time-empty = ist leer; bitte eine Zeit in Sekunden eingeben
upload-not-a-file = ist keine Datei dieses Hochladens
upload-not-read = „{ $channel }“ wird aus diesen Dateien nicht gelesen; bitte einen der Liste wählen
upload-no-rows = liegt nicht nach dem Anfang, oder es liegt keine Zeile dazwischen
upload-nothing-excluded = in diesem Bereich ist nichts ausgeschlossen
upload-choose-template = bitte eine der Liste wählen
upload-listed-twice = ist zweimal genannt, oder es sind zu viele Dateien
upload-file-names = bitte Dateien mit Namen von 1 bis 200 Bytes wählen
upload-cannot-read = eine Datei ist nicht lesbar; ihre Fehler stehen unten
upload-expired = dieses Hochladen ist abgelaufen oder schon gespeichert; bitte die Dateien neu wählen

## Felder eines Versuchs

mapping-depth-heading = Wassertiefe
mapping-depth-unit = m, leer für tiefes Wasser
mapping-depth-label = Wassertiefe, m
mapping-revolutions = Drehzahl
mapping-revolutions-unit = 1/min, wo keine aufgezeichnet ist
mapping-revolutions-label = Drehzahl, 1/min
mapping-revolutions-of = Drehzahl von { $file }, 1/min
mapping-current = Strömung
mapping-current-unit = kn, abgezogen
mapping-current-label = Strömung, kn
mapping-current-of = Strömung von { $file }, kn
mapping-towards = Setzt nach
mapping-towards-unit = °
mapping-towards-label = Setzt nach, °
mapping-towards-of = Richtung der Strömung von { $file }, °
upload-positive-depth = muss über 0 liegen; für tiefes Wasser leer lassen
upload-positive-revolutions = muss über 0 liegen; leer lassen, wo die Datei sie aufzeichnet
