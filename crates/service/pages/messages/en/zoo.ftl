zoo-heading = The zoo: laws of motion and effects
zoo-explained = A law is the structure of the equations of motion; a model is a law with coefficients. An effect adds to a law, such as wind, current or a faulty instrument.
zoo-laws = Laws
zoo-description = Description
zoo-roll = Roll
zoo-inputs = Inputs
zoo-effects = Effects
zoo-effect = Effect
zoo-forms = Forms
zoo-library = Ships with a published model are in the <a href="/?ships=library">library</a>.

## A law

law-kicker = law
law-default = , default { $value }
law-file = File
law-yaml = YAML file
law-equations = Equations of motion
law-equations-explained = The mass matrix M times the accelerations equals the sums below: for each axis the scale times the sum of coefficients times their regressors, plus the rest without a scale. u, v, r: surge, sway, yaw rate; δ: rudder; n: revolutions; L<sub>pp</sub>: length, B: beam, d: draught, ρ: density of water.
law-mass = Mass matrix
law-scale = Scale:
law-open = + further terms by the factors below
law-rest = Rest:
law-factors = Factors in the names of coefficients
law-factors-label = Factors
law-values = Intermediate values
law-values-label = Values
law-submodels = Submodels
law-submodel-where = where { $conditions }: { $meaning }
law-and = {" "}and{" "}
law-parameters = Parameters
law-parameter = Parameter
law-meaning = Meaning
law-from = From particulars
law-sources = Sources

## An effect

effect-kicker = effect
effect-force = <code>{ $name }</code>; it adds forces.
effect-inflow = <code>{ $name }</code>; it changes the inflow of hull, propeller or rudder.
effect-measurement = <code>{ $name }</code>; it changes the readings of instruments.
effect-searched = Its terms are selected from products of the states.
effect-needs = Needs the channels { $channels }.
effect-formulas = Formulas
effect-bounds = Bounds
formula-sees = inflow in place of { $name }
formula-adds = adds to { $name }
formula-accelerates = accelerates { $name } by
formula-becomes = { $name } becomes
formula-lag = lag of { $name }
formula-dead-band = dead band of { $name }
formula-reads = { $name } is read as
