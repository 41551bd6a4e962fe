version-heading = { $ship }, versjon { $number }
version-kicker = versjon

## Opplysninger

version-use = Bruk
version-use-text = Manøvrer med { $ship } i stille vann
version-use-unknown = ; området for dataene er ukjent
version-use-within = , innenfor <a href="#range">området prøvene dekker</a>
version-use-speed = ; utgangsfart { $speed }
version-note = Merknad
version-more = Mer
version-acceptance = Godkjenningssammendrag
version-simulate = Simuler
version-compare = Sammenlign
version-validation = Validering
version-document = Dokument som JSON
version-large-uncertainty = <strong>Stor usikkerhet.</strong> 95 %-båndene for noen av tallene nedenfor overstiger ±25 % av verdien. En prøve med denne manøveren ville gjøre dem smalere.

## Standardmanøvrer

version-standard = Standardmanøvrer og vurdering etter IMO
version-simulated = Simulert i stille, dypt vann.
version-simulated-from = Simulert i stille, dypt vann fra { $speed }.
version-bands = Båndene inneholder 95 % av modellene som er trukket fra posterioren.
version-criteria = IMO-kriterier
version-criteria-caption = IMO-standarder for skips manøvreringsevne, MSC.137(76); den dårligste siden teller
version-criterion = Kriterium
version-limit = Grense
version-verdict = Vurdering
version-met-by = Oppfylt av
version-figures = Tall fra standardmanøvrene
version-band = 95 %-bånd
version-wide = (bredt)
range-text = { $low } til { $high }
pass-met = oppfylt
pass-not-met = ikke oppfylt
pass-unknown = ukjent
imo-not-evaluated = Kriteriene i MSC.137(76) kunne ikke vurderes.
imo-fails = Modellen oppfyller ikke MSC.137(76): { $criteria }.
imo-partly = Modellen oppfyller de kriteriene i MSC.137(76) som den når; ukjent: { $criteria }.
imo-meets = Modellen oppfyller alle kriteriene i MSC.137(76).

## Effekter, område, koeffisienter

version-effects = Effekter
version-range = Området prøvene dekker
version-range-unknown = Bevegelsesområdet for dataene er ukjent.
version-range-explained = En simulering utenfor dette området får en advarsel.
version-validity = Gyldighet
version-quantity = Størrelse
version-least = Minste
version-greatest = Største
version-coefficients = Koeffisienter
version-coefficients-explained = Etter akse, de dataene bestemmer best først: standardfeil høyst en firedel av verdien. De øvrige bygger på kilden.
version-coefficients-of = Koeffisienter, { $axis }
version-coefficients-count = { $count ->
        [one] 1 koeffisient
       *[other] { $count } koeffisienter
    }
version-determined = , { $count } bestemt
version-coefficient = Koeffisient
version-error = Standardfeil
version-relative = Relativ

## Grenser og opphav

version-unknown = Det som ikke er kjent
version-unknown-range = Manøvrer utenfor området ovenfor, og ved andre hastigheter, lastetilstander og dybder, er ekstrapolert.
version-unknown-bands = Versjonen har ingen usikkerhetsbånd: hvor langt tallene er til å stole på, er ikke oppgitt.
version-unknown-trials = Den er ikke tilpasset prøver av skipet.
version-unknown-validation = <a href="{ $address }">Validering etter ITTC</a> sammenligner den med prøver den ikke har sett, der de finnes.
version-lineage = Opphav og oppskrift
version-lineage-label = Opphav
version-ancestor = forløper
version-descendant = etterfølger
version-fitted-to = Tilpasset prøvene { $trials }.
version-recipe = Oppskrift som gjenskaper versjonen byte for byte
lineage-label = Opphavet til { $version }; listen nedenfor har samme innhold
lineage-trials = { $count ->
        [one] fra 1 prøve
       *[other] fra { $count } prøver
    }
lineage-effects = med { $effects }
