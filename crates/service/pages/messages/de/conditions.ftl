conditions-title = Bedingungen der Versuche von { $ship }
conditions-heading = Bedingungen der Versuche
conditions-explained = Die Abnahmeübersicht nennt sie, und kein Instrument zeichnet sie auf. Unbekanntes bleibt offen. Jede Angabe wird mit Verfasser und Zeit aufbewahrt; die neueste gilt.
conditions-no-trials = Das Schiff hat noch keine Versuche. Bitte zuerst <a href="{ $address }">Versuche hochladen</a>.
conditions-trials = Versuche mit diesen Bedingungen
conditions-stated-for = angegeben für { $date }
conditions-legend = Bedingungen
conditions-save = Bedingungen speichern
conditions-choose-trials = bitte die Versuche mit diesen Bedingungen wählen

## Felder

stated-date = Datum der Versuche
stated-place = Ort
stated-place-hint = Zum Beispiel Skagerrak, 57,9 N 9,8 O
stated-wind = Wind
stated-wind-hint = Zum Beispiel 6 m/s aus Südwest, Beaufort 4
stated-sea = Seegang und Dünung
stated-sea-hint = Zum Beispiel signifikante Höhe 0,5 m, Seegang 2
stated-depth = Wassertiefe
stated-depth-hint = Zum Beispiel 180 m oder tief
stated-draught-fore-m = Tiefgang vorn, m
stated-draught-aft-m = Tiefgang achtern, m
stated-displacement = Verdrängung während der Versuche
stated-displacement-hint = Zum Beispiel 21 800 t
stated-instruments = Instrumente
stated-instruments-hint = Zum Beispiel DGPS, Kreiselkompass, Doppler-Log
stated-remarks = Bemerkungen
stated-remarks-hint = Zum Beispiel Ballastzustand, Rumpf im Mai gereinigt
