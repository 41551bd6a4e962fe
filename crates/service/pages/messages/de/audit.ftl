audit-explained = Alle Änderungen mit ihren Urhebern, die neuesten zuerst. Einträge sind nicht änderbar; jeder enthält die Prüfsumme des vorigen, und <code>sistership fsck</code> prüft sie alle. <a href="/v1/audit">Als JSON</a>
audit-by = Von
audit-about-hint = Über, als ship:NAME
audit-number = Nummer
audit-when = Wann
audit-who = Wer
audit-what = Was
audit-about = Über
audit-from = Von wo
audit-details = Einzelheiten
audit-show = zeigen
audit-before = Vorher:
audit-after = Nachher:
audit-earlier = Frühere Einträge
audit-only-one = bitte nur eines von beiden angeben

## Sätze

audit-of-subject = { $noun } { $name } { $verb }
audit-of-other = { $noun } von { $kind } { $name } { $verb }
audit-unknown-verb = { $verb } ({ $noun }), { $kind } { $name }
audit-name-of-ship = { $own } von { $ship }
audit-of-ship = von { $ship }
audit-verb-create = angelegt
audit-verb-update = geändert
audit-verb-delete = gelöscht
audit-verb-undelete = wiederhergestellt
audit-verb-move = verschoben
audit-verb-tag = mit Schlagwort versehen
audit-verb-untag = von einem Schlagwort befreit
audit-verb-note = mit einer Notiz versehen
audit-verb-cancel = abgebrochen
audit-verb-retry = wiederholt
audit-verb-enable = freigeschaltet
audit-verb-disable = gesperrt
audit-verb-revoke = widerrufen
audit-verb-begin = begonnen
audit-verb-end = beendet
audit-verb-add = um ein Mitglied ergänzt
audit-verb-set = gesetzt
audit-verb-save = gespeichert
audit-verb-sign = unterschrieben
audit-verb-conditions = mit Bedingungen versehen

## Arten von Gegenständen

audit-noun-ship = Schiff
audit-noun-version = Version
audit-noun-alias = Alias
audit-noun-trial = Versuch
audit-noun-job = Auftrag
audit-noun-family = Familie
audit-noun-user = Benutzer
audit-noun-key = Schlüssel
audit-noun-session = Sitzung
audit-noun-webhook = Webhook
audit-noun-template = Vorlage
audit-noun-setting = Einstellung
audit-noun-law = Modellstruktur
audit-noun-report = Bericht
audit-noun-diagnosis = Diagnose
audit-noun-roles = Rollen
audit-noun-settings = Einstellungen

## Arten von Gegenständen für sich

audit-subject-ship = Schiff
audit-subject-version = Version
audit-subject-trial = Versuch
audit-subject-job = Auftrag
audit-subject-family = Familie
audit-subject-user = Benutzer
audit-subject-key = Schlüssel
audit-subject-webhook = Webhook
audit-subject-law = Modellstruktur
audit-subject-diagnosis = Diagnose
audit-subject-session = Sitzung
audit-subject-template = Vorlage
audit-subject-settings = Einstellungen
