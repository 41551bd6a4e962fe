families-explained = Skip med modeller som har et felles grunnlag. Prioren til en familie beskriver hvordan medlemmene avviker fra grunnlaget.
families-members = Medlemmer
families-further = Flere familier
families-new = Ny familie
families-short-name = Kortnavn
families-short-name-hint = Små bokstaver, sifre og bindestreker. Det kan ikke endres senere.
families-foundation = Grunnlag
families-foundation-hint = Versjonen alle medlemmene begynner med, som skip/nummer
families-members-hint = Skip, atskilt med mellomrom; flere kan legges til senere
families-create = Opprett familien

## En familie

family-json = Som JSON
family-json-family = familie
family-json-prior = prior
family-json-drift = modelldrift
family-json-refinements = forfininger
family-condition = Tilstanden til medlemmene
family-condition-explained = Skip med en modell som ikke gjelder, står først, deretter de med størst modelldrift: forholdet mellom den uforklarte kraften på nye prøver og den på de tilpassede. Uforklart kraft i en prøve: dens kvadratiske middel delt på det til den samlede kraften, for aksen der den er størst.
family-diagnosis = Diagnose
family-drift = Modelldrift
family-over-time = Uforklart kraft over tid
family-newest-trial = Nyeste prøve
family-newest = { $at }: { $share } %
family-newest-fitted = { $at }: { $share } % (tilpasset)
family-no-members = Ingen medlemmer ennå.
family-add-ships = Legg til skip
family-add-hint = Atskilt med mellomrom
family-add = Legg til
