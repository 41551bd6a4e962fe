## Hoveddata

particular-lpp-m = Lengde mellom perpendikulærene
particular-loa-m = Lengde over alt
particular-beam-m = Bredde
particular-draught-m = Dypgang
particular-draught-m-hint = Midtskips, under prøvene
particular-displacement-m3 = Deplasement
particular-displacement-m3-hint = Volum
particular-service-speed-m-s = Servicefart
particular-service-speed-m-s-hint = Eller i knop, som 20 kn
particular-draught-fore-m = Dypgang forut
particular-draught-aft-m = Dypgang akterut
particular-block-coefficient = Blokkoeffisient
particular-x-g-m = Tyngdepunkt forenfor midtskips
particular-yaw-gyradius-ratio = Treghetsradius i gir
particular-yaw-gyradius-ratio-hint = Delt på lengden
particular-roll-gyradius-ratio = Treghetsradius i rull, delt på bredden
particular-rudder-area-m2 = Rorareal
particular-rudder-height-m = Rorhøyde
particular-rudder-aspect-ratio = Rorets sideforhold
particular-propeller-diameter-m = Propelldiameter
particular-propeller-blades = Propellblader
particular-propeller-pitch-ratio = Propellens stigningsforhold
particular-gm-m = Metasenterhøyde GM
particular-kg-m = Tyngdepunktets høyde KG
particular-km-m = Metasenterets høyde KM
particular-kb-m = Oppdriftssenterets høyde KB
particular-depth-moulded-m = Dybde i riss
particular-mass-kg = Masse
particular-water-density-kg-m3 = Vannets tetthet
particular-frontal-area-m2 = Frontareal over vann
particular-lateral-area-m2 = Sideareal over vann

## Skjema for hoveddata

new-ship-heading = Legg til et skip
new-ship-explained = Hoveddimensjonene er nok til å begynne med: med dem finnes de publiserte skipene som ligner. Den første modellen lages ved en forfining på prøvene.
new-ship-ship = Skipet
new-ship-name-hint = Slik det er kjent, for eksempel M/V Anna
new-ship-short-name = Kortnavn for adresser (valgfritt)
new-ship-short-name-hint = Små bokstaver, sifre og bindestreker, for eksempel anna; ellers laget av navnet. Det kan ikke endres senere.
new-ship-category-hint = Skip sammenlignes innenfor en gruppe kategorier, for eksempel tanker eller dry-cargo
new-ship-source = Kilde for tallene
new-ship-source-hint = For eksempel generalarrangement, trim- og stabilitetsbok
new-ship-dimensions = Hoveddimensjoner
new-ship-further = Flere hoveddata, hvis de er kjent
new-ship-by-program = Et program sender i stedet en skipsfil med modeller til <code>POST /v1/ships</code>.
particulars-title = Hoveddata for { $ship }
particulars-explained = Versjoner som finnes, beholder de dataene de ble laget med; den neste forfiningen bruker disse. Et endret tall får kilden som oppgis nedenfor.
particulars-further = Flere hoveddata
particulars-source = Kilde for de endrede tallene
particulars-source-hint = For eksempel dypgangsmåling 28. november 2026
particulars-save = Lagre hoveddata

## Tall fra manøvrer

figure-advance = framspring (advance)
figure-transfer = sideforskyvning (transfer)
figure-tactical-diameter = taktisk diameter
figure-steady-radius = stasjonær svingeradius
figure-steady-turning-radius = stasjonær svingeradius
figure-speed-loss = fartstap
figure-first-overshoot = første oversvingsvinkel
figure-second-overshoot = andre oversvingsvinkel
figure-period = periode
figure-initial-turning = innledende sving
figure-initial-turning-time = innledende svingetid
figure-of-turn = svingesirkel { $rudder }°: { $figure }
figure-of-zigzag = sikksakk { $angles }: { $figure }

## Kriterier i MSC.137(76)

criterion-advance = framspring (advance)
criterion-tactical-diameter = taktisk diameter
criterion-initial-turning-ability = innledende svingeevne
criterion-10-10-first-overshoot = første oversvingsvinkel 10/10
criterion-10-10-second-overshoot = andre oversvingsvinkel 10/10
criterion-20-20-first-overshoot = første oversvingsvinkel 20/20

## Registrerte størrelser

variable-u = langskips hastighet
variable-v = tverrskips hastighet
variable-r = girhastighet
variable-psi = kurs
variable-x = posisjon nord
variable-y = posisjon øst
variable-position = posisjon
variable-phi = rullevinkel
variable-p = rullehastighet
variable-delta = rorvinkel
variable-n = propellturtall
variable-wind-speed = vindhastighet
variable-wind-from = vindretning
variable-apparent-wind-speed = relativ vindhastighet
variable-apparent-wind-from = relativ vind fra baugen
variable-depth = vanndybde
variable-time = tid
variable-t = tid
axis-X = langskips kraft X
axis-Y = tverrskips kraft Y
axis-K = rullemoment K
axis-N = girmoment N
axis-parameters = parametere i modellstrukturen
axis-other = andre
new-ship-add = Legg til skipet

## Enheter

unit-deg = °
unit-deg-s = °/s
