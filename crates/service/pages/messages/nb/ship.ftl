## Tilstand og neste steg

ship-family = familie
ship-condition = Tilstand
ship-since = Dette gjelder siden prøven { $trial }, lastet opp { $at }.
ship-diagnosis-report = Rapport fra diagnosen
ship-with-effects = <a href="{ $address }">Versjon { $number }</a> er modellen med de manglende effektene; den kan tas i bruk nedenfor.
ship-based-on = Basert på { $count } diagnoser
ship-all-trials = alle prøver: { $trials }
verdict-complete = fullstendig
verdict-effects = effekter
verdict-unexplained = uforklart
verdict-drift = modelldrift
condition-no-champion = Ukjent: det finnes ingen aktiv versjon ennå.
condition-not-diagnosed = Ukjent: den aktive versjonen er ikke diagnostisert på en prøve ennå.
condition-holds = Modellen gjelder: på { $trials } stemmer residualet med støyen.
condition-count-trials = { $count ->
        [one] 1 prøve
       *[other] { $count } prøver
    }
condition-fails = Modellen gjelder ikke: { $evidence }.
condition-fails-since = Modellen gjelder ikke siden prøven { $since }: { $evidence }.
condition-some-trials = { $against } av { $all }
condition-lacks = på { $trials } mangler { $effects }
condition-lacks-more = på { $trials } mangler { $effects }, og noe som ingen kjent effekt forklarer
condition-unexplained = på { $trials } mangler noe som ingen kjent effekt forklarer
condition-drifted = den uforklarte kraften på nye prøver er { $ratio } ganger den på de tilpassede prøvene (akse { $axis })
next-label = Neste steg
next-job-runs = En jobb for dette skipet pågår ({ $kind }): { $percent } %.
next-see-progress = Se fremdriften
next-no-trials = Skipet har ingen prøver ennå. Svingesirkler og sikksakkprøver forteller mest.
next-upload = Last opp prøver
next-not-refined = Skipet har prøver, men ingen modell som er tilpasset dem.
next-refine = Forfin modellen
next-has-effects = Versjon { $number } har de manglende effektene.
next-look-at-version = Se på versjon { $number }
next-none-in-use = Ingen versjon er i bruk ennå.
next-look-at-newest = Se på den nyeste versjonen
next-newer = Versjon { $number } er i bruk, og det finnes en nyere.
next-compare = Sammenlign dem
next-not-diagnosed = Versjon { $number } er ikke diagnostisert siden den ble tatt i bruk.
next-diagnose = Diagnostiser den
next-has-report = Versjon { $number } er i bruk. Rapporten har dommen over den.
next-look-at-report = Se på rapporten
next-in-use = Versjon { $number } er i bruk.
next-look-at-it = Se på den

## Handlinger

actions-heading = Flere handlinger: last opp, forfin, diagnostiser, ta i bruk, merkelapper, notater
action-upload-explained = CSV, Parquet, Excel, MATLAB, HDF5, NetCDF, GPX, MCAP, NMEA 0183 eller 2000; kanalen til hver kolonne vises og kan rettes før prøvene lagres.
action-choose-files = Velg filer
action-refine = Forfin
action-refine-explained = Tilpasser en modell til alle prøvene av skipet. Med standardinnstillingene sammenlignes alle kilder, modellstrukturer og metoder etter feilen på tilbakeholdte manøvrer.
method-select = sammenlign alle og velg den beste
method-weak = weak: likninger integrert over vinduer
method-trajectory = trajectory: minste kvadrater på simulerte segmenter
method-published = published: ettstegsdifferanser
method-cma-es = cma-es: evolusjonært søk på simuleringer
action-diagnose = Diagnostiser
action-diagnose-explained = Undersøker om en versjon fortsatt beskriver skipets bevegelse, på prøver den ikke er tilpasset, og finner ellers de manglende effektene.
action-promote = Ta i bruk, eller gå tilbake
action-promote-explained = Den aktive versjonen kalles «champion». Hvis en annen bruker har endret den siden denne siden ble lastet, avvises forespørselen. Hver endring registreres med sin begrunnelse.
action-champion-mark = (aktiv)
action-make-champion = Ta den i bruk
action-roll-back = Gå tilbake til versjon { $number }
action-roll-back-reason = gått tilbake på skipets side
action-tags = Merkelapper
action-remove-tag = Fjern merkelappen { $tag }
action-remove = fjern
action-new-tag = Ny merkelapp
action-add-tag = Legg til merkelapp
action-note = Notat
action-note-explained = Opplysninger til andre brukere, for eksempel arbeid på skroget. Notater kan ikke endres og viser hvem som skrev dem.
action-add-note = Legg til notat

## Versjoner og prøver

ship-versions = Versjoner av modellen
ship-aliases = Aliaser
ship-made-from = Laget av
ship-by = Av
ship-mark-version = Merk versjon { $number }
ship-report-link = rapport
ship-no-versions = Ingen ennå: last opp prøver og forfin.
ship-compare-marked = Sammenlign de merkede versjonene
ship-all-versions = Alle versjoner som JSON
ship-compare-newest = Sammenlign de to nyeste
ship-simulate = Simuler den aktive versjonen
ship-champion-yaml = Aktiv versjon som YAML
ship-state-conditions = Oppgi dato, sted, vær og lastetilstand
ship-all-trials-json = Alle prøver som JSON
ship-notes = Notater
ship-all-notes = Alle notater som JSON

## Hoveddata og lignende skip

ship-particulars = Hoveddata
ship-change-particulars = Endre hoveddata
ship-revision = Revisjon { $number } av skipets dokument
ship-particular = Størrelse
ship-drawing-explained = I målestokk: lengde, bredde, dypgang, dybde i riss, ror og propell som oppgitt. Skroglinjene er skjematiske.
drawing-label = { $title } i målestokk: lengde { $length } m, bredde { $beam } m
drawing-midship = midtskips, bredde { $beam } m
drawing-gravity = G { $distance } m fra midtskips
drawing-draught = dypgang { $draught } m
drawing-rudder = ror { $area } m²
drawing-propeller = propelldiameter { $diameter } m
ship-similar = Lignende skip
ship-eligible = Egnet som kilde
ship-reasons = Grunner
ship-none-comparable = Ingen andre skip er sammenlignbare.
ship-all-by-similarity = Alle skip etter likhet
ship-ranking-json = Rangering som også bruker prøvene, som JSON
