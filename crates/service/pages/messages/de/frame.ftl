## Navigation und Fußzeile

frame-skip = Zum Inhalt springen
frame-menu = Menü
frame-main = Hauptnavigation
place-fleet = Flotte
place-compare = Vergleich
place-playground = Simulation
place-families = Familien
place-zoo = Modellzoo
place-jobs = Aufträge
place-users = Benutzer
place-audit = Protokoll
frame-units = Zeiten in UTC, Werte in SI-Einheiten; positive Ruderlage dreht das Schiff nach Steuerbord.
frame-language = Sprache

## Wörter, die mehrere Seiten gemeinsam haben

word-yes = ja
word-no = nein
word-none = Keine.
word-none-yet = Noch keine.
word-none-option = keine
word-all = alle
word-default = Standard
word-show = Anzeigen
word-mark = Auswählen
word-ship = Schiff
word-ships = Schiffe
word-version = Version
word-versions = Versionen
word-number-version = Version { $number }
word-law = Modellstruktur
word-method = Verfahren
word-report = Bericht
word-name = Name
word-title = Bezeichnung
word-category = Kategorie
word-family = Familie
word-value = Wert
word-unit = Einheit
word-source = Quelle
word-reason = Begründung
word-created = Angelegt
word-trials = Versuche
word-trial = Versuch
word-manoeuvre = Manöver
word-samples = Messpunkte
word-duration = Dauer
word-remarks = Hinweise
word-remark = Hinweis
word-uploaded = Hochgeladen
word-held-out-error = Validierungsfehler
word-lacks = Fehlt
word-not-reached = nicht erreicht
word-count-trials = { $count ->
        [one] 1 Versuch
       *[other] { $count } Versuche
    }
list-and = { $first } und { $last }

## Formulare

form-empty = ist leer; bitte einen Wert eingeben
form-required = ist erforderlich
form-not-a-number = „{ $text }“ ist keine Zahl; Zahlen wie 12,5 schreiben
form-outside = muss zwischen { $low } und { $high } liegen, nicht bei { $number }
form-not-whole = „{ $text }“ ist keine ganze Zahl
form-cursor = ist keine Seite dieser Liste; bitte mit der ersten Seite neu beginnen
form-no-model = es gibt kein Modell „{ $name }“; ein Schiff (dessen aktive Version), Schiff/Nummer oder Schiff/Alias angeben

## Auswahl einer Rolle

role-add = Rolle hinzufügen
role-role = Rolle
role-on = Gilt für
role-on-server = den ganzen Server
role-on-ship = das Schiff
role-on-family = die Familie
role-scope-name = Name des Schiffes oder der Familie
role-reader = Leser
role-engineer = Ingenieur
role-approver = Freigebender
role-admin = Administrator
role-of-ship = { $role } für das Schiff { $name }
role-of-family = { $role } für die Familie { $name }

## Fehler

problem-back = Bitte zurückgehen und die Eingabe korrigieren, oder mit der <a href="/">Flotte</a> fortfahren.
problem-bad-request = Die Anfrage kann nicht gelesen werden
problem-unauthorized = Ein Schlüssel oder eine Anmeldung ist nötig
problem-forbidden = Die Anfrage ist nicht erlaubt
problem-not-found = Nicht gefunden
problem-method-not-allowed = Die Methode wird hier nicht unterstützt
problem-not-acceptable = Keines der akzeptierten Formate ist verfügbar
problem-request-timeout = Die Anfrage kam zu langsam an
problem-conflict = Die Anfrage widerspricht gespeicherten Daten
problem-stale = Der Gegenstand wurde seit dem Lesen geändert
problem-too-large = Die Anfrage ist zu groß
problem-unsupported-media-type = Dieser Inhaltstyp wird hier nicht unterstützt
problem-invalid = Der Inhalt ist ungültig
problem-precondition-required = Eine Vorbedingung im Kopf der Anfrage ist nötig
problem-too-many-requests = Zu viele Anfragen
problem-headers-too-large = Die Kopfzeilen sind zu groß
problem-internal = Interner Fehler
problem-unavailable = Der Server ist vorübergehend nicht verfügbar
problem-timeout = Die Anfrage dauerte zu lange
problem-no-room = Es ist kein Speicherplatz frei
language-unknown = es gibt keine Sprache „{ $code }“; en, de oder nb wählen
