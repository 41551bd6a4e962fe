## Navigasjon og bunntekst

frame-skip = Hopp til innholdet
frame-menu = Meny
frame-main = Hovednavigasjon
place-fleet = Flåte
place-compare = Sammenlign
place-playground = Simulering
place-families = Familier
place-zoo = Modellzoo
place-jobs = Jobber
place-users = Brukere
place-audit = Endringslogg
frame-units = Tider er i UTC, verdier i SI-enheter; positiv rorvinkel dreier skipet mot styrbord.
frame-language = Språk

## Ord som flere sider har felles

word-yes = ja
word-no = nei
word-none = Ingen.
word-none-yet = Ingen ennå.
word-none-option = ingen
word-all = alle
word-default = standard
word-show = Vis
word-mark = Merk
word-ship = Skip
word-ships = Skip
word-version = Versjon
word-versions = Versjoner
word-number-version = versjon { $number }
word-law = Modellstruktur
word-method = Metode
word-report = Rapport
word-name = Navn
word-title = Tittel
word-category = Kategori
word-family = Familie
word-value = Verdi
word-unit = Enhet
word-source = Kilde
word-reason = Begrunnelse
word-created = Opprettet
word-trials = Prøver
word-trial = Prøve
word-manoeuvre = Manøver
word-samples = Måleverdier
word-duration = Varighet
word-remarks = Merknader
word-remark = Merknad
word-uploaded = Lastet opp
word-held-out-error = Valideringsfeil
word-lacks = Mangler
word-not-reached = ikke nådd
word-count-trials = { $count ->
        [one] 1 prøve
       *[other] { $count } prøver
    }
list-and = { $first } og { $last }

## Skjemaer

form-empty = er tomt; skriv inn en verdi
form-required = er påkrevd
form-not-a-number = «{ $text }» er ikke et tall; skriv et tall som 12,5
form-outside = må være fra { $low } til { $high }, ikke { $number }
form-not-whole = «{ $text }» er ikke et helt tall
form-cursor = er ikke en side i denne listen; begynn på nytt med den første siden
form-no-model = det finnes ingen modell «{ $name }»; skriv et skip (dets aktive versjon), skip/nummer eller skip/alias

## Valg av rolle

role-add = Legg til rollen
role-role = Rolle
role-on = Gjelder for
role-on-server = hele serveren
role-on-ship = skipet
role-on-family = familien
role-scope-name = Navn på skipet eller familien
role-reader = leser
role-engineer = ingeniør
role-approver = godkjenner
role-admin = administrator
role-of-ship = { $role } for skipet { $name }
role-of-family = { $role } for familien { $name }

## Feil

problem-back = Gå tilbake for å rette inndataene, eller fortsett med <a href="/">flåten</a>.
problem-bad-request = Forespørselen kan ikke leses
problem-unauthorized = En nøkkel eller innlogging er nødvendig
problem-forbidden = Forespørselen er ikke tillatt
problem-not-found = Ikke funnet
problem-method-not-allowed = Metoden støttes ikke her
problem-not-acceptable = Ingen av de godtatte formatene er tilgjengelige
problem-request-timeout = Forespørselen brukte for lang tid på å komme frem
problem-conflict = Forespørselen er i konflikt med lagrede data
problem-stale = Innholdet er endret siden det ble lest
problem-too-large = Forespørselen er for stor
problem-unsupported-media-type = Innholdstypen støttes ikke her
problem-invalid = Innholdet er ikke gyldig
problem-precondition-required = Et betingelsesfelt i hodet er nødvendig
problem-too-many-requests = For mange forespørsler
problem-headers-too-large = Hodefeltene er for store
problem-internal = Intern feil
problem-unavailable = Serveren er midlertidig utilgjengelig
problem-timeout = Forespørselen tok for lang tid
problem-no-room = Det er ingen ledig plass
language-unknown = det finnes ikke noe språk «{ $code }»; velg en, de eller nb
