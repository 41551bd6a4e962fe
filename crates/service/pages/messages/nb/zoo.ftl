zoo-heading = Modellzooen: modellstrukturer og effekter
zoo-explained = En modellstruktur er oppbygningen av bevegelseslikningene; en modell er en modellstruktur med koeffisienter. En effekt føyer noe til, som vind, strøm eller et defekt instrument.
zoo-laws = Modellstrukturer
zoo-description = Beskrivelse
zoo-roll = Rulling
zoo-inputs = Inndata
zoo-effects = Effekter
zoo-effect = Effekt
zoo-forms = Former
zoo-library = Skip med en publisert modell er i <a href="/?ships=library">biblioteket</a>.

## En modellstruktur

law-kicker = modellstruktur
law-default = , standard { $value }
law-file = Fil
law-yaml = YAML-fil
law-equations = Bevegelseslikninger
law-equations-explained = Massematrisen M ganger akselerasjonene er lik summene nedenfor: for hver akse skalaen ganger summen av koeffisientene ganger regressorene, pluss resten uten skala. u, v, r: jag-, svai- og girhastighet; δ: rorvinkel; n: turtall; L<sub>pp</sub>: lengde, B: bredde, d: dypgang, ρ: vannets tetthet.
law-mass = Massematrise
law-scale = Skala:
law-open = + flere ledd etter faktorene nedenfor
law-rest = Rest:
law-factors = Faktorer i navnene på koeffisientene
law-factors-label = Faktorer
law-values = Mellomverdier
law-values-label = Verdier
law-submodels = Delmodeller
law-submodel-where = der { $conditions }: { $meaning }
law-and = {" "}og{" "}
law-parameters = Parametere
law-parameter = Parameter
law-meaning = Betydning
law-from = Fra hoveddata
law-sources = Kilder

## En effekt

effect-kicker = effekt
effect-force = <code>{ $name }</code>; den legger til krefter.
effect-inflow = <code>{ $name }</code>; den endrer innstrømningen til skrog, propell eller ror.
effect-measurement = <code>{ $name }</code>; den endrer avlesningene av instrumenter.
effect-searched = Leddene velges fra produkter av tilstandene.
effect-needs = Trenger kanalene { $channels }.
effect-formulas = Formler
effect-bounds = Grenser
formula-sees = innstrømning i stedet for { $name }
formula-adds = legges til { $name }
formula-accelerates = akselererer { $name } med
formula-becomes = { $name } blir
formula-lag = tidsforsinkelse i { $name }
formula-dead-band = dødsone for { $name }
formula-reads = { $name } leses som
