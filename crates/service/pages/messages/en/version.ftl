version-heading = { $ship }, version { $number }
version-kicker = version

## Facts

version-use = Intended use
version-use-text = Manoeuvres of { $ship } in calm water
version-use-unknown = ; the range of its data is unknown
version-use-within = , within the <a href="#range">range covered by its trials</a>
version-use-speed = ; approach speed { $speed }
version-note = Note
version-more = More
version-acceptance = Acceptance summary
version-simulate = Simulate
version-compare = Compare
version-validation = Validation
version-document = Document as JSON
version-large-uncertainty = <strong>Large uncertainty.</strong> The 95 % bands of some figures below exceed plus or minus 25 % of the value. A trial of that manoeuvre would narrow them.

## Standard manoeuvres

version-standard = Standard manoeuvres and verdict of IMO
version-simulated = Simulated in calm, deep water.
version-simulated-from = Simulated in calm, deep water from { $speed }.
version-bands = Bands contain 95 % of models drawn from the posterior.
version-criteria = IMO criteria
version-criteria-caption = IMO standards for ship manoeuvrability, MSC.137(76); the worse of both sides counts
version-criterion = Criterion
version-limit = Limit
version-verdict = Verdict
version-met-by = Met by
version-figures = Figures of the standard manoeuvres
version-band = 95 % band
version-wide = (wide)
range-text = { $low } to { $high }
pass-met = met
pass-not-met = not met
pass-unknown = unknown
imo-not-evaluated = The criteria of MSC.137(76) could not be evaluated.
imo-fails = The model does not meet MSC.137(76): { $criteria }.
imo-partly = The model meets the criteria of MSC.137(76) that it reaches; unknown: { $criteria }.
imo-meets = The model meets all criteria of MSC.137(76).

## Effects, range, coefficients

version-effects = Effects
version-range = Range covered by trials
version-range-unknown = The range of motion of its data is unknown.
version-range-explained = A simulation outside this range has a warning.
version-validity = Validity
version-quantity = Quantity
version-least = Least
version-greatest = Greatest
version-coefficients = Coefficients
version-coefficients-explained = By axis, those that the data determine best first: standard error at most a quarter of the value. The others rest on the source.
version-coefficients-of = Coefficients, { $axis }
version-coefficients-count = { $count ->
        [one] 1 coefficient
       *[other] { $count } coefficients
    }
version-determined = , { $count } determined
version-coefficient = Coefficient
version-error = Standard error
version-relative = Relative

## Limits and lineage

version-unknown = What is not known
version-unknown-range = Manoeuvres outside the range above, and at other speeds, loadings and depths, are extrapolated.
version-unknown-bands = The version has no uncertainty bands: how far its figures can be relied on is not stated.
version-unknown-trials = It was not fitted to trials of the ship.
version-unknown-validation = <a href="{ $address }">Validation after ITTC</a> compares it with trials that it has not seen, where there are any.
version-lineage = Lineage and recipe
version-lineage-label = Lineage
version-ancestor = ancestor
version-descendant = descendant
version-fitted-to = Fitted to the trials { $trials }.
version-recipe = Recipe, which reproduces the version byte for byte
lineage-label = Lineage of { $version }; the list below has the same content
lineage-trials = { $count ->
        [one] of 1 trial
       *[other] of { $count } trials
    }
lineage-effects = with { $effects }
