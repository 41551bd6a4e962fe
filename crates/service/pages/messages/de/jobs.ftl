jobs-explained = Verfeinerungen, Diagnosen und Arbeiten an Familien, die neuesten zuerst.
jobs-state = Zustand
jobs-earlier = Frühere Aufträge
jobs-requested = Angefordert
jobs-begun = Begonnen
jobs-ended = Beendet
jobs-kind = Art
jobs-done = Fertig
jobs-outcome = Ergebnis
job-state-queued = wartet
job-state-running = läuft
job-state-succeeded = erfolgreich
job-state-failed = fehlgeschlagen
job-state-cancelled = abgebrochen
job-kind-refinement = Verfeinerung
job-kind-diagnosis = Diagnose
job-kind-bulk-refinement = Verfeinerung einer Familie
job-kind-branch = Korrektur
job-of-ship = { $kind } von { $ship }
job-progress = Fortschritt
job-reloads = Diese Seite lädt alle drei Sekunden neu.
job-correct-and-retry = Bitte korrigieren, was die Meldung nennt, zum Beispiel die <a href="/ships/{ $ship }#trials">Versuche</a> oder die <a href="/ships/{ $ship }/particulars">Schiffsangaben</a>, und dann wiederholen; oder <a href="/ships/{ $ship }">mit anderen Einstellungen neu beginnen</a>.
job-correct = Bitte korrigieren, was die Meldung nennt, und dann wiederholen.
job-ship-page = Seite des Schiffes
job-attempts = Ausführungsversuche
job-stopping = Der Auftrag hält beim nächsten Schritt an.
job-cancel = Abbrechen
job-retry = Wiederholen
job-request = Anfrage
job-no-state = es gibt keinen Zustand „{ $name }“

## Ergebnisse in Worten

outcome-version = Version { $number }, { $alias }
outcome-version-from = Version { $number }, { $alias }, aus { $from }
outcome-diagnosed = { $model } diagnostiziert: { $verdict }
outcome-lacks = { $model } diagnostiziert: es fehlt { $effects }; Version { $number }
job-kind-family-prior = Prior einer Familie
