## Overskrifter og samlinger

fleet-title = Flåte
fleet-collections = Samlinger
fleet-own = Egen flåte
fleet-library = Bibliotek
fleet-library-heading = Bibliotek med publiserte skip
fleet-all = Alle skip
fleet-add = Legg til et skip
fleet-library-explained = Publiserte skip som følger med programmet: kilder for forfining, og eksempler. Et skip med egne prøver hører til egen flåte.
fleet-changing = Noen skip ble nettopp endret; denne rekkefølgen oppdateres i løpet av sekunder.

## Første steg

steps-label = Første steg
step-state-done = ferdig
step-state-next = nå
step-state-later = senere
step-add-title = Legg til skipet
step-add-text = Lengde, bredde, dypgang og deplasement er nok til å begynne med.
step-upload-title = Last opp prøvene
step-upload-text = Svingesirkler og sikksakkprøver, slik de er registrert; kolonnene gjenkjennes.
step-refine-title = Forfin modellen
step-refine-text = Modellen av det mest like skipet tilpasses prøvene og vurderes på manøvrer den ikke har sett.
steps-looking = Vil du bare se deg om?
steps-example = Last inn eksempelet
steps-example-explained = legger til et containerskip på 175 m med åtte simulerte prøver, klart til forfining

## Oversikt

board-counts = Skip etter tilstand
board-worst = Trenger oppmerksomhet først
board-recent = Endret denne uken
board-drift = Modelldrift i flåten
board-drift-explained = Uforklart kraft på nye prøver delt på den på de tilpassede: median av diagnosene hver uke, med antallet. Over linjen er en modell i tvil.
board-drift-label = Median modelldrift for diagnosene hver uke, { $last } i den siste; over { $limit } er en modell i tvil
board-today = i dag
board-unexplained = noe uforklart
change-diagnosed-complete = en diagnose fant at ingenting mangler
change-diagnosed-effects = en diagnose fant en manglende effekt
change-diagnosed-other = en diagnose fant en uforklart rest
change-promoted = versjon { $number } ble tatt i bruk
change-made = versjon { $number } ble laget
change-uploaded = { $count ->
        [one] 1 prøve ble lastet opp
       *[other] { $count } prøver ble lastet opp
    }
change-added = skipet ble lagt til

## Tilstand

condition-class-does-not-hold = gjelder ikke
condition-class-unknown = ikke diagnostisert
condition-class-no-model = ingen modell
condition-class-holds = gjelder
condition-drift = modelldrift
condition-drift-times = modelldrift, { $ratio } ganger

## Søk

search-heading = Søk og sorter
search-all-ships = alle
search-own = egen flåte
search-library = bibliotek
search-condition = Tilstand
search-order = Rekkefølge
search-order-worst = dårligste først
search-order-name = navn
search-order-value = verdien av størrelsen eller tallet
search-from = Navn fra og med (sortert etter navn)
search-further = Søk etter kategori, merkelapp, hoveddata, manøvrer og likhet
search-tag = Merkelapp
search-similar = Mest lik skipet
search-particular = En størrelse fra hoveddataene, SI
search-least = Minst
search-most = Høyst
search-figure-legend = Et tall fra standardmanøvrene til den aktive versjonen, det største av begge sider
search-figure = Tall
search-correlation = Korrelasjon
search-wrong-order = velg worst, name eller value, ikke «{ $text }»
search-order-by-name = sortering etter navn er bare mulig uten tilstand, hoveddata og tall; sorter etter verdi eller dårligste først
search-order-by-value = sortering etter verdi trenger et område for en størrelse fra hoveddataene eller et tall
search-no-class = det finnes ingen «{ $name }»

## Liste

fleet-none-own = Ingen egne skip ennå. <a href="/?ships=library">Biblioteket med publiserte skip</a> kan ses på, sammenlignes og simuleres.
fleet-compare-marked = Sammenlign de merkede skipene
fleet-compare-hint = to til fem, hvert med den aktive versjonen
fleet-mark-ship = Merk { $ship }
fleet-in-use = I bruk
fleet-unexplained = Uforklart kraft
fleet-no-match = Ingen skip passer.
fleet-further = Flere skip
fleet-spark = Uforklart kraft i { $count } prøver over tid, { $last } % i den siste

## Hva kolonnene betyr

columns-heading = Hva kolonnene betyr
columns-in-use = den aktive versjonen av skipet, «champion»
columns-holds-name = Gjelder
columns-holds = residualet til den aktive versjonen på de nyeste prøvene stemmer med støyen
columns-does-not-hold-name = Gjelder ikke
columns-does-not-hold = en effekt mangler; den nevnes hvis biblioteket har en som forklarer residualet
columns-unknown-name = Ikke diagnostisert
columns-unknown = den aktive versjonen er ikke diagnostisert
columns-error = midlere kvadratiske feil for simulerte, tilbakeholdte manøvrer, delt på variansen av målingen: 0 er perfekt, 1 ikke bedre enn middelverdien
columns-force = uforklart kraft i hver av de nyeste 24 prøvene, den eldste først; hver linje har sin egen skala

## Kart

map-heading = Hvor skipene er
map-explained = Sist kjente posisjoner: de fra de nyeste prøvene med bredde og lengde. <span class="state does-not-hold">kryss: gjelder ikke</span> · trekant: ikke diagnostisert · kvadrat: ingen modell · <span class="good">sirkel: gjelder</span>.
map-most-urgent = De { $shown } mest presserende av { $placed } skip vises.
map-source = Kystlinjer: Natural Earth.
map-table = Posisjoner som tabell
map-positions = Posisjoner
map-position = Posisjon
map-label = Kart over skipene; tabellen nedenfor har samme innhold
map-mark = { $ship }: { $condition }
map-direction-N = N
map-direction-S = S
map-direction-E = Ø
map-direction-W = V
