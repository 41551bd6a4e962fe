## Anmeldung und Konto

sign-in-heading = Anmelden
sign-in-password = Passwort
sign-in-with = Anmelden über { $provider }
sign-in-hint = Benutzername und Passwort vergibt ein Administrator; er kann das Passwort auch zurücksetzen. Programme verwenden einen Dienstschlüssel.
account-roles = Eigene Rollen
account-no-roles = Noch keine: Rollen vergibt ein Administrator.
account-old-password = Bisheriges Passwort
account-new-password = Neues Passwort, mindestens 15 Zeichen
account-change-password = Passwort ändern
account-provider = Anmeldung über einen Anbieter
account-no-provider = Mit diesem Konto ist noch kein Anbieter verknüpft.
account-link = Mit { $provider } verknüpfen
account-session = Sitzung
account-sign-out = Abmelden
account-local = Hier besteht kein Konto: Der Zugang erfolgt von diesem Rechner oder mit einem Schlüssel.
account-password-changed = Das Passwort ist geändert; auf anderen Geräten ist eine neue Anmeldung nötig.
account-linked = Das Konto ist verknüpft.
leave-heading = Konto verknüpfen
leave-explained = Nach der Anmeldung bei { $provider } wird das dortige Konto mit diesem verknüpft, sodass es auch hier zur Anmeldung dient.
leave-continue = Weiter zu { $provider }
leave-cancel = Abbrechen

## Benutzer

users-on-this-page = Auf dieser Seite: Benutzer, <a href="#keys">Dienstschlüssel</a> von Programmen, <a href="#approval">Freigabe</a>. Nachrichten an Chaträume und Programme: <a href="/webhooks">Webhooks</a>.
users-roles-explained = Ein Leser liest, ein Ingenieur lädt außerdem hoch und verfeinert, ein Freigebender setzt außerdem Versionen ein, ein Administrator verwaltet außerdem Personen. Jede Rolle hat die Rechte der vorhergehenden, auf dem ganzen Server oder für ein Schiff oder eine Familie.
users-user-name = Benutzername
users-roles = Rollen
users-since = Seit
users-state = Zustand
users-linked-with = verknüpft mit { $issuer }:
users-change = ändern
users-save-roles = Rollen speichern
users-new-password-of = Neues Passwort von { $name }
users-set = setzen
users-enabled = aktiv
users-disabled = gesperrt
users-disable = sperren
users-enable = freischalten
users-further = Weitere Benutzer
users-new = Neuer Benutzer
users-new-name = Benutzername (später nicht änderbar)
users-new-title = Name der Person
users-new-initial = Anfangspasswort, mindestens 15 Zeichen
users-create = Anlegen

## Dienstschlüssel

keys-heading = Dienstschlüssel
keys-explained = Für Programme. Ein Schlüssel wird nur einmal gezeigt; der Server behält Anfang und Prüfsumme.
keys-key = Schlüssel
keys-purpose = Zweck
keys-on-behalf = Im Namen von
keys-expires = Läuft ab
keys-last-used = Zuletzt benutzt
keys-revoke = Widerrufen
keys-revoke-button = widerrufen
keys-revoke-one = { $key } widerrufen
keys-revoked = widerrufen { $at }
keys-until-revoked = bei Widerruf
keys-never-used = nie
keys-further = Weitere Schlüssel
keys-new = Neuer Schlüssel
keys-new-user = Im Namen des Benutzers (optional)
keys-new-days = Läuft ab nach Tagen (optional)
keys-create = Schlüssel anlegen
keys-new-heading = Neuer Schlüssel: { $title }
keys-copy-now = Bitte jetzt kopieren: Er wird nicht noch einmal gezeigt.
keys-usage = Ein Programm sendet ihn als <code>Authorization: Bearer KEY</code>.
keys-back = Benutzer und Schlüssel

## Freigabe

approval-heading = Freigabe durch eine zweite Person
approval-on = Eine Version wird nur mit der Freigabe eines Benutzers aktiv, der sie nicht angelegt hat.
approval-off = Ein Ingenieur darf eine eigene Version zur aktiven machen.
approval-turn-off = Keine Freigabe verlangen
approval-turn-on = Freigabe verlangen

## Webhooks

webhooks-heading = Webhooks
webhooks-explained = Nachrichten an ein Postfach, einen Chatraum oder ein Programm, wenn sich das Modell eines Schiffes ändert oder zweifelhaft ist. Kanäle von Slack und Microsoft Teams, erkannt an ihrer Adresse, und Postfächer erhalten einen Satz mit Verweis; andere Empfänger erhalten JSON mit Signatur.
webhooks-format = Format
webhooks-sent-when = Gesendet, wenn
webhooks-last = Letzte Nachricht
webhooks-end = beenden
webhooks-end-one = { $title } beenden
webhooks-ended = beendet
webhooks-all-ships = alle Schiffe
webhooks-none-sent = noch keine
webhooks-arrived = angekommen { $at }
webhooks-not-arrived = nicht angekommen: { $why }
webhooks-not-sent = noch nicht gesendet
webhooks-event-champion = eine andere Version aktiv wird
webhooks-event-diagnosis = eine Diagnose findet, dass das Modell nicht gilt
webhooks-event-drift = das Modell driftet
webhooks-event-other = ein anderes Ereignis eintritt
webhooks-new = Neuer Webhook
webhooks-purpose-hint = Zum Beispiel Kanal der Flotte
webhooks-address = Adresse
webhooks-send-when = Nachricht senden, wenn
webhooks-ship = Schiff (optional)
webhooks-ship-hint = Kurzname; sonst alle Schiffe
webhooks-drift = Modelldrift über (optional)
webhooks-drift-hint = Unerklärte Kraft auf neuen Versuchen geteilt durch die auf den angepassten; sonst 2
webhooks-create = Webhook anlegen
webhooks-links = Verweise in Nachrichten
webhooks-server = Adresse dieses Servers
webhooks-server-hint = Wie sie im Browser geöffnet wird, zum Beispiel https://ships.example.com; ohne sie haben Nachrichten keinen Verweis
webhooks-save = Speichern
webhooks-new-heading = Neuer Webhook: { $title }
webhooks-secret = Ein Programm, das die Signatur prüft, braucht dieses Geheimnis. Bitte jetzt kopieren: Es wird nicht noch einmal gezeigt. Ein Chatraum braucht keines.
webhooks-signature = Jede Lieferung hat die Kopfzeile <code>Sistership-Signature: t=SECONDS,v1=HEX</code>, den HMAC-SHA256 von <code>SECONDS.BODY</code> mit dem Geheimnis.

## Ablehnungen

sign-in-other-site = bitte auf der Seite dieses Servers anmelden; die Anfrage kommt von einer anderen Website
account-wrong-password = ist nicht das bisherige Passwort
account-sign-in-first = bitte zuerst anmelden; ein Schlüssel oder dieser Rechner hat kein Passwort
account-sign-in-to-link = bitte zuerst anmelden, damit es ein Konto zum Verknüpfen gibt
webhooks-mail-hint = Wie von Slack, Teams oder dem Programm angegeben, beginnend mit https://; oder mailto: und ein Postfach, zum Beispiel mailto:master@example.com
webhooks-no-mail-hint = Wie von Slack, Teams oder dem Programm angegeben, beginnend mit https://. E-Mail braucht einen Server, der sie sendet: SISTERSHIP_SMTP_URL und --mail-from
