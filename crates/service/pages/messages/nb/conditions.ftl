conditions-title = Forhold under prøvene av { $ship }
conditions-heading = Forhold under prøvene
conditions-explained = Godkjenningssammendraget oppgir dem, og ingen instrumenter registrerer dem. La det ukjente stå åpent. Hver opplysning lagres med forfatter og tid; den nyeste gjelder.
conditions-no-trials = Skipet har ingen prøver ennå. <a href="{ $address }">Last opp prøver</a> først.
conditions-trials = Prøver med disse forholdene
conditions-stated-for = oppgitt for { $date }
conditions-legend = Forhold
conditions-save = Lagre forholdene
conditions-choose-trials = velg prøvene med disse forholdene

## Felt

stated-date = Dato for prøvene
stated-place = Sted
stated-place-hint = For eksempel Skagerrak, 57,9 N 9,8 Ø
stated-wind = Vind
stated-wind-hint = For eksempel 6 m/s fra sørvest, Beaufort 4
stated-sea = Sjø og dønning
stated-sea-hint = For eksempel signifikant bølgehøyde 0,5 m, sjøgang 2
stated-depth = Vanndybde
stated-depth-hint = For eksempel 180 m, eller dypt
stated-draught-fore-m = Dypgang forut, m
stated-draught-aft-m = Dypgang akterut, m
stated-displacement = Deplasement under prøvene
stated-displacement-hint = For eksempel 21 800 t
stated-instruments = Instrumenter
stated-instruments-hint = For eksempel DGPS, gyrokompass, dopplerlogg
stated-remarks = Merknader
stated-remarks-hint = For eksempel ballasttilstand, skroget rengjort i mai
