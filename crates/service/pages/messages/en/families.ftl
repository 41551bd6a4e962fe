families-explained = Ships whose models share a foundation. The prior of a family describes how its members differ from the foundation.
families-members = Members
families-further = Further families
families-new = New family
families-short-name = Short name
families-short-name-hint = Lower-case letters, digits and hyphens. It cannot be changed later.
families-foundation = Foundation
families-foundation-hint = The version with which all members begin, as ship/number
families-members-hint = Ships, separated by spaces; more can be added later
families-create = Create the family

## A family

family-json = As JSON
family-json-family = family
family-json-prior = prior
family-json-drift = drift
family-json-refinements = refinements
family-condition = Condition of the members
family-condition-explained = Ships whose model does not hold are first, then those with the largest drift: the ratio of the unexplained force on new trials to that on the fitted trials. Unexplained force of a trial: its root mean square divided by that of the total force, for the axis where it is largest.
family-diagnosis = Diagnosis
family-drift = Drift
family-over-time = Unexplained force over time
family-newest-trial = Newest trial
family-newest = { $at }: { $share } %
family-newest-fitted = { $at }: { $share } % (fitted)
family-no-members = No members yet.
family-add-ships = Add ships
family-add-hint = Separated by spaces
family-add = Add
