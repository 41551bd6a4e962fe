## Innlogging og konto

sign-in-heading = Logg inn
sign-in-password = Passord
sign-in-with = Logg inn med { $provider }
sign-in-hint = Brukernavn og passord fås av en administrator, som også kan tilbakestille passordet. Programmer bruker en tjenestenøkkel.
account-roles = Dine roller
account-no-roles = Ingen ennå: en administrator tildeler roller.
account-old-password = Nåværende passord
account-new-password = Nytt passord, minst 15 tegn
account-change-password = Endre passord
account-provider = Innlogging via en leverandør
account-no-provider = Ingen leverandør er knyttet til denne kontoen ennå.
account-link = Knytt til { $provider }
account-session = Økt
account-sign-out = Logg ut
account-local = Det finnes ingen konto her: tilgangen er fra denne maskinen eller med en nøkkel.
account-password-changed = Passordet er endret; logg inn på nytt på andre enheter.
account-linked = Kontoen er koblet.
leave-heading = Koble til kontoen
leave-explained = Logg inn hos { $provider }. Kontoen der blir da koblet til denne, slik at den også kan brukes til å logge inn her.
leave-continue = Fortsett til { $provider }
leave-cancel = Avbryt

## Brukere

users-on-this-page = På denne siden: brukere, <a href="#keys">tjenestenøkler</a> for programmer, <a href="#approval">godkjenning</a>. Meldinger til chatterom og programmer: <a href="/webhooks">webhooks</a>.
users-roles-explained = En leser ser, en ingeniør laster også opp og forfiner, en godkjenner tar også versjoner i bruk, en administrator forvalter også personer. Hver rolle har rettighetene til de foregående, på hele serveren eller for ett skip eller én familie.
users-user-name = Brukernavn
users-roles = Roller
users-since = Siden
users-state = Tilstand
users-linked-with = koblet til { $issuer }:
users-change = endre
users-save-roles = Lagre rollene
users-new-password-of = Nytt passord for { $name }
users-set = sett
users-enabled = aktiv
users-disabled = sperret
users-disable = sperr
users-enable = åpne
users-further = Flere brukere
users-new = Ny bruker
users-new-name = Brukernavn (kan ikke endres senere)
users-new-title = Navn på personen
users-new-initial = Første passord, minst 15 tegn
users-create = Opprett

## Tjenestenøkler

keys-heading = Tjenestenøkler
keys-explained = For programmer. En nøkkel vises bare én gang; serveren beholder starten og en sjekksum.
keys-key = Nøkkel
keys-purpose = Formål
keys-on-behalf = På vegne av
keys-expires = Utløper
keys-last-used = Sist brukt
keys-revoke = Trekk tilbake
keys-revoke-button = trekk tilbake
keys-revoke-one = Trekk tilbake { $key }
keys-revoked = trukket tilbake { $at }
keys-until-revoked = ved tilbaketrekking
keys-never-used = aldri
keys-further = Flere nøkler
keys-new = Ny nøkkel
keys-new-user = På vegne av brukeren (valgfritt)
keys-new-days = Utløper etter dager (valgfritt)
keys-create = Opprett nøkkel
keys-new-heading = Ny nøkkel: { $title }
keys-copy-now = Kopier den nå: den vises ikke igjen.
keys-usage = Et program sender den som <code>Authorization: Bearer KEY</code>.
keys-back = Brukere og nøkler

## Godkjenning

approval-heading = Godkjenning av en annen person
approval-on = En versjon blir aktiv bare med godkjenning fra en bruker som ikke har laget den.
approval-off = En ingeniør kan ta en egen versjon i bruk.
approval-turn-off = Ikke krev godkjenning
approval-turn-on = Krev godkjenning

## Webhooks

webhooks-heading = Webhooks
webhooks-explained = Meldinger til en postkasse, et chatterom eller et program når modellen av et skip endres eller er i tvil. Kanaler i Slack og Microsoft Teams, som kjennes igjen på adressen, og postkasser får en setning med lenke; andre mottakere får JSON med signatur.
webhooks-format = Format
webhooks-sent-when = Sendes når
webhooks-last = Siste melding
webhooks-end = avslutt
webhooks-end-one = Avslutt { $title }
webhooks-ended = avsluttet
webhooks-all-ships = alle skip
webhooks-none-sent = ingen ennå
webhooks-arrived = kom frem { $at }
webhooks-not-arrived = kom ikke frem: { $why }
webhooks-not-sent = ikke sendt ennå
webhooks-event-champion = en annen versjon er i bruk
webhooks-event-diagnosis = en diagnose finner at modellen ikke gjelder
webhooks-event-drift = modellen viser modelldrift
webhooks-event-other = en annen hendelse inntreffer
webhooks-new = Ny webhook
webhooks-purpose-hint = For eksempel kanalen til flåten
webhooks-address = Adresse
webhooks-send-when = Send en melding når
webhooks-ship = Skip (valgfritt)
webhooks-ship-hint = Kortnavn; ellers alle skip
webhooks-drift = Modelldrift over (valgfritt)
webhooks-drift-hint = Uforklart kraft på nye prøver delt på den på de tilpassede; ellers 2
webhooks-create = Opprett webhooken
webhooks-links = Lenker i meldinger
webhooks-server = Adressen til denne serveren
webhooks-server-hint = Slik den åpnes i nettleseren, for eksempel https://ships.example.com; uten den har meldinger ingen lenke
webhooks-save = Lagre
webhooks-new-heading = Ny webhook: { $title }
webhooks-secret = Et program som kontrollerer signaturen, trenger denne hemmeligheten. Kopier den nå: den vises ikke igjen. Et chatterom trenger ingen.
webhooks-signature = Hver leveranse har hodefeltet <code>Sistership-Signature: t=SECONDS,v1=HEX</code>, HMAC-SHA256 av <code>SECONDS.BODY</code> med hemmeligheten.

## Avslag

sign-in-other-site = logg inn på siden til denne serveren; forespørselen kommer fra et annet nettsted
account-wrong-password = er ikke det nåværende passordet
account-sign-in-first = logg inn først; en nøkkel eller denne maskinen har ikke noe passord
account-sign-in-to-link = logg inn først, slik at det finnes en konto å koble til
webhooks-mail-hint = Slik Slack, Teams eller programmet oppgir den, med https:// først; eller mailto: og en postkasse, for eksempel mailto:master@example.com
webhooks-no-mail-hint = Slik Slack, Teams eller programmet oppgir den, med https:// først. E-post trenger en server som sender den: SISTERSHIP_SMTP_URL og --mail-from
