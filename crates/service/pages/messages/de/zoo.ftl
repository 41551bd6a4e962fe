zoo-heading = Der Modellzoo: Modellstrukturen und Effekte
zoo-explained = Eine Modellstruktur ist der Aufbau der Bewegungsgleichungen; ein Modell ist eine Modellstruktur mit Koeffizienten. Ein Effekt ergänzt sie, etwa Wind, Strömung oder ein fehlerhaftes Instrument.
zoo-laws = Modellstrukturen
zoo-description = Beschreibung
zoo-roll = Rollen
zoo-inputs = Eingänge
zoo-effects = Effekte
zoo-effect = Effekt
zoo-forms = Formen
zoo-library = Schiffe mit veröffentlichtem Modell stehen in der <a href="/?ships=library">Bibliothek</a>.

## Eine Modellstruktur

law-kicker = Modellstruktur
law-default = , Standard { $value }
law-file = Datei
law-yaml = YAML-Datei
law-equations = Bewegungsgleichungen
law-equations-explained = Die Massenmatrix M mal den Beschleunigungen ist gleich den Summen unten: für jede Achse die Skala mal der Summe der Koeffizienten mal ihren Regressoren, plus der Rest ohne Skala. u, v, r: Längs-, Quer- und Giergeschwindigkeit; δ: Ruderlage; n: Drehzahl; L<sub>pp</sub>: Länge, B: Breite, d: Tiefgang, ρ: Dichte des Wassers.
law-mass = Massenmatrix
law-scale = Skala:
law-open = + weitere Terme nach den Faktoren unten
law-rest = Rest:
law-factors = Faktoren in den Namen der Koeffizienten
law-factors-label = Faktoren
law-values = Zwischenwerte
law-values-label = Werte
law-submodels = Teilmodelle
law-submodel-where = für { $conditions }: { $meaning }
law-and = {" "}und{" "}
law-parameters = Parameter
law-parameter = Parameter
law-meaning = Bedeutung
law-from = Aus Schiffsangaben
law-sources = Quellen

## Ein Effekt

effect-kicker = Effekt
effect-force = <code>{ $name }</code>; er fügt Kräfte hinzu.
effect-inflow = <code>{ $name }</code>; er ändert die Anströmung von Rumpf, Propeller oder Ruder.
effect-measurement = <code>{ $name }</code>; er ändert die Anzeige von Instrumenten.
effect-searched = Seine Terme werden aus Produkten der Zustände gewählt.
effect-needs = Braucht die Kanäle { $channels }.
effect-formulas = Formeln
effect-bounds = Grenzen
formula-sees = Anströmung statt { $name }
formula-adds = addiert sich zu { $name }
formula-accelerates = beschleunigt { $name } um
formula-becomes = { $name } wird
formula-lag = Verzögerung von { $name }
formula-dead-band = Totbereich von { $name }
formula-reads = { $name } wird gelesen als
