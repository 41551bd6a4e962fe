## Filer velges

upload-title = Last opp prøver av { $ship }
upload-explained = Velg filene til én eller flere prøver: CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 eller 2000. Filer med de samme kolonnene er separate prøver; en fil med andre kolonner leses som en ekstra sensor til prøven med det mest like navnet. Den neste siden viser kanalen til hver kolonne og en forhåndsvisning; prøvene lagres først etter en bekreftelse.
upload-files = Filer
upload-preview = Forhåndsvis

## Lesing av kolonnene

mapping-title = Kontroll av opplastingen for { $ship }
mapping-kicker = opplasting
mapping-heading = Kontroller opplastingen
mapping-accepted = <strong>Alle filene kan leses.</strong> Kontroller de merkede kolonnene, rett dem om nødvendig, og lagre prøvene.
mapping-refused = <strong>Noen filer kan ikke leses ennå.</strong> Feilene står under hver fil. Rett kolonnene og kontroller på nytt.
mapping-offer = { $file } har de samme kolonnene som malen <strong>{ $template }</strong>.
mapping-use-offer = Bruk denne malen
mapping-by-template = Kolonnene leses etter malen <strong>{ $template }</strong>.
mapping-columns = Kolonner
mapping-column = Kolonne
mapping-read-as = Leses som
mapping-sign = Fortegn
mapping-confidence = Sikkerhet
mapping-over-99 = over 99 %
mapping-why = Hvorfor
mapping-channel-of = Kanal for { $column }
mapping-ignored = leses ikke
mapping-unit-of = Enhet for { $column }
mapping-reverse = Snu fortegnet til { $column }
mapping-reversed = snudd
mapping-check = kontroller:
mapping-given = oppgitt på denne siden
mapping-signs = Fortegn og referansesystemer
mapping-rudder = Positiv rorvinkel
mapping-rudder-starboard = dreier skipet mot styrbord
mapping-rudder-port = dreier det mot babord
mapping-velocity = u og v er hastigheter
mapping-velocity-ground = over grunn
mapping-velocity-water = gjennom vannet
mapping-missing = Rader med manglende verdi
mapping-missing-bridge = fylles der hullet er kort
mapping-missing-drop = hoppes over
mapping-missing-refuse = gjør at filen avvises
mapping-derive = Utled fra bane og kurs
mapping-file = Fil
mapping-manoeuvre-of = Manøver for { $file }
mapping-manoeuvre-example = sikksakk 10/10
mapping-depth-of = Dybde for { $file }
mapping-diagnose = Diagnostiser den aktive versjonen på de nye prøvene
mapping-check-again = Kontroller på nytt
mapping-store = Lagre prøvene

## Utelatelser

excluded-heading = Utelatte verdier
excluded-explained = Instrumentfeil er utelatt, og ellers er ingenting endret. Fjern merket for det som skal tas med igjen, eller oppgi et tidsrom, som to klikk i et diagram nedenfor fyller inn; kontroller så på nytt.
excluded-exclude = Utelat
excluded-values = Verdier og grunn
excluded-rows = Rader i filen
excluded-one = Utelat { $summary }
excluded-nothing = Ingenting er utelatt.
excluded-channel = Kanal
excluded-whole-rows = alle: hele rader
excluded-from = Fra [s]
excluded-to = Til [s]
excluded-range = Utelat området
excluded-restore = Ta området med igjen

## Maler

templates-heading = Maler
templates-explained = Ta vare på hvordan kolonnene leses, med rettelsene, for de neste filene av denne formen.
templates-for = For
templates-this-ship = dette skipet
templates-server = alle skip på serveren
templates-of-server = { $name } (server)
templates-keep = Ta vare på malen
templates-kept = Lagrede maler
templates-choose = velg
templates-use = Bruk
templates-remove = Fjern
templates-removed = ble fjernet; velg en annen

## Forhåndsvisning

preview-heading = Filer med disse innstillingene
preview-samples = { $rows } måleverdier over { $duration }.
preview-row = rad { $row },
preview-remarks = { $count ->
        [one] 1 merknad
       *[other] { $count } merknader
    }
preview-track = Bane for { $name }
preview-channels = Kanaler for { $name } over tid; det som er utelatt, er skyggelagt
preview-manifest = Manifestet, for kommandolinjen

## Etter opplastingen

stored-title = Prøver av { $ship } er lagret
stored-heading = { $count ->
        [one] 1 prøve er lagret
       *[other] { $count } prøver er lagret
    }
stored-diagnosed = Den aktive versjonen diagnostiseres på de nye prøvene: <a href="{ $address }">fremdrift og resultat</a>.
stored-next = Neste steg: en forfining tilpasser en modell til alle prøvene av skipet. Med standardinnstillingene sammenlignes alle kilder, modellstrukturer og metoder etter feilen på tilbakeholdte manøvrer.
stored-further = Last opp flere prøver
stored-other = Andre innstillinger, og alle prøver av skipet

## Feil

upload-read-already = «{ $column }» leses allerede som { $channel }; velg én kolonne
upload-no-channel = «{ $channel }» er ikke en kanal; velg en fra listen
upload-one-of = må være { $one } eller { $other }
upload-missing-values = må være bridge, drop eller refuse
upload-time-empty = er tomt; skriv inn en tid i sekunder
upload-not-a-file = er ikke en fil i denne opplastingen
upload-not-read = «{ $channel }» leses ikke fra disse filene; velg en fra listen
upload-no-rows = er ikke etter starten, eller det er ingen rader mellom dem
upload-nothing-excluded = ingenting er utelatt i dette området
upload-choose-template = velg en fra listen
upload-listed-twice = er oppført to ganger, eller det er for mange filer
upload-file-names = velg filer med navn på 1 til 200 byte
upload-cannot-read = en fil kan ikke leses; se feilene nedenfor
upload-expired = denne opplastingen er utløpt eller allerede lagret; velg filene på nytt

## Felt for en prøve

mapping-depth-heading = Dybde
mapping-depth-unit = m, tom for dypt vann
mapping-depth-label = Dybde, m
mapping-revolutions = Turtall
mapping-revolutions-unit = o/min, der ingen er registrert
mapping-revolutions-label = Turtall, o/min
mapping-revolutions-of = Turtall for { $file }, o/min
mapping-current = Strøm
mapping-current-unit = kn, trukket fra
mapping-current-label = Strøm, kn
mapping-current-of = Strøm for { $file }, kn
mapping-towards = Setter mot
mapping-towards-unit = °
mapping-towards-label = Setter mot, °
mapping-towards-of = Strømretning for { $file }, °
upload-positive-depth = må være over 0; la den stå tom for dypt vann
upload-positive-revolutions = må være over 0; la den stå tom der filen registrerer dem
