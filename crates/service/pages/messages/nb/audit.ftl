audit-explained = Alle endringer med opphavsperson, de nyeste først. Oppføringer kan ikke endres; hver inneholder sjekksummen av den forrige, og <code>sistership fsck</code> kontrollerer alle. <a href="/v1/audit">Som JSON</a>
audit-by = Av
audit-about-hint = Om, som ship:NAVN
audit-number = Nummer
audit-when = Når
audit-who = Hvem
audit-what = Hva
audit-about = Om
audit-from = Fra
audit-details = Detaljer
audit-show = vis
audit-before = Før:
audit-after = Etter:
audit-earlier = Tidligere oppføringer
audit-only-one = oppgi bare én av de to

## Setninger

audit-of-subject = { $verb } { $noun } { $name }
audit-of-other = { $verb } { $noun } for { $kind } { $name }
audit-unknown-verb = { $verb } ({ $noun }), { $kind } { $name }
audit-name-of-ship = { $own } for { $ship }
audit-of-ship = for { $ship }
audit-verb-create = opprettet
audit-verb-update = endret
audit-verb-delete = slettet
audit-verb-undelete = gjenopprettet
audit-verb-move = flyttet
audit-verb-tag = merket
audit-verb-untag = fjernet en merkelapp fra
audit-verb-note = la et notat til
audit-verb-cancel = avbrøt
audit-verb-retry = gjentok
audit-verb-enable = åpnet
audit-verb-disable = sperret
audit-verb-revoke = trakk tilbake
audit-verb-begin = begynte
audit-verb-end = avsluttet
audit-verb-add = la et medlem til
audit-verb-set = satte
audit-verb-save = lagret
audit-verb-sign = skrev under
audit-verb-conditions = oppga forholdene for

## Typer objekter

audit-noun-ship = skipet
audit-noun-version = versjonen
audit-noun-alias = aliaset
audit-noun-trial = prøven
audit-noun-job = jobben
audit-noun-family = familien
audit-noun-user = brukeren
audit-noun-key = nøkkelen
audit-noun-session = økten
audit-noun-webhook = webhooken
audit-noun-template = malen
audit-noun-setting = innstillingen
audit-noun-law = modellstrukturen
audit-noun-report = rapporten
audit-noun-diagnosis = diagnosen
audit-noun-roles = rollene
audit-noun-settings = innstillingene

## Typer objekter for seg

audit-subject-ship = skip
audit-subject-version = versjon
audit-subject-trial = prøve
audit-subject-job = jobb
audit-subject-family = familie
audit-subject-user = bruker
audit-subject-key = nøkkel
audit-subject-webhook = webhook
audit-subject-law = modellstruktur
audit-subject-diagnosis = diagnose
audit-subject-session = økt
audit-subject-template = mal
audit-subject-settings = innstillinger
