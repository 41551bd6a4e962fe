jobs-explained = Forfininger, diagnoser og arbeid med familier, de nyeste først.
jobs-state = Tilstand
jobs-earlier = Tidligere jobber
jobs-requested = Bestilt
jobs-begun = Begynt
jobs-ended = Avsluttet
jobs-kind = Type
jobs-done = Ferdig
jobs-outcome = Resultat
job-state-queued = venter
job-state-running = kjører
job-state-succeeded = fullført
job-state-failed = mislyktes
job-state-cancelled = avbrutt
job-kind-refinement = forfining
job-kind-diagnosis = diagnose
job-kind-bulk-refinement = forfining av en familie
job-kind-branch = korreksjon
job-of-ship = { $kind } av { $ship }
job-progress = Fremdrift
job-reloads = Denne siden lastes på nytt hvert tredje sekund.
job-correct-and-retry = Rett det meldingen nevner, for eksempel <a href="/ships/{ $ship }#trials">prøvene</a> eller <a href="/ships/{ $ship }/particulars">hoveddataene</a> til skipet, og prøv igjen; eller <a href="/ships/{ $ship }">begynn på nytt med andre innstillinger</a>.
job-correct = Rett det meldingen nevner, og prøv igjen.
job-ship-page = Siden til skipet
job-attempts = Forsøk
job-stopping = Jobben stopper ved neste steg.
job-cancel = Avbryt
job-retry = Prøv igjen
job-request = Forespørsel
job-no-state = det finnes ingen tilstand «{ $name }»

## Resultater i ord

outcome-version = versjon { $number }, { $alias }
outcome-version-from = versjon { $number }, { $alias }, fra { $from }
outcome-diagnosed = { $model } diagnostisert: { $verdict }
outcome-lacks = { $model } diagnostisert: mangler { $effects }; versjon { $number }
job-kind-family-prior = prior for en familie
