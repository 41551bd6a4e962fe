version-heading = { $ship }, Version { $number }
version-kicker = Version

## Angaben

version-use = Verwendung
version-use-text = Manöver von { $ship } in ruhigem Wasser
version-use-unknown = ; der Bereich der Daten ist unbekannt
version-use-within = , im <a href="#range">Bereich ihrer Versuche</a>
version-use-speed = ; Anfangsgeschwindigkeit { $speed }
version-note = Anmerkung
version-more = Weiteres
version-acceptance = Abnahmeübersicht
version-simulate = Simulieren
version-compare = Vergleichen
version-validation = Validierung
version-document = Dokument als JSON
version-large-uncertainty = <strong>Große Unsicherheit.</strong> Die 95-%-Bänder einiger Kenngrößen unten überschreiten ±25 % des Wertes. Ein Versuch mit diesem Manöver würde sie verengen.

## Standardmanöver

version-standard = Standardmanöver und Urteil nach IMO
version-simulated = Simuliert in ruhigem, tiefem Wasser.
version-simulated-from = Simuliert in ruhigem, tiefem Wasser ab { $speed }.
version-bands = Die Bänder enthalten 95 % der aus dem Posterior gezogenen Modelle.
version-criteria = IMO-Kriterien
version-criteria-caption = IMO-Normen für die Manövrierfähigkeit von Schiffen, MSC.137(76); die schlechtere Seite zählt
version-criterion = Kriterium
version-limit = Grenzwert
version-verdict = Urteil
version-met-by = Erfüllt von
version-figures = Kenngrößen der Standardmanöver
version-band = 95-%-Band
version-wide = (breit)
range-text = { $low } bis { $high }
pass-met = erfüllt
pass-not-met = nicht erfüllt
pass-unknown = unbekannt
imo-not-evaluated = Die Kriterien von MSC.137(76) konnten nicht ausgewertet werden.
imo-fails = Das Modell erfüllt MSC.137(76) nicht: { $criteria }.
imo-partly = Das Modell erfüllt die erreichten Kriterien von MSC.137(76); unbekannt: { $criteria }.
imo-meets = Das Modell erfüllt alle Kriterien von MSC.137(76).

## Effekte, Bereich, Koeffizienten

version-effects = Effekte
version-range = Bereich der Versuche
version-range-unknown = Der Bewegungsbereich der Daten ist unbekannt.
version-range-explained = Eine Simulation außerhalb dieses Bereichs trägt eine Warnung.
version-validity = Gültigkeit
version-quantity = Größe
version-least = Kleinster
version-greatest = Größter
version-coefficients = Koeffizienten
version-coefficients-explained = Nach Achse, die von den Daten am besten bestimmten zuerst: Standardfehler höchstens ein Viertel des Wertes. Die übrigen beruhen auf der Quelle.
version-coefficients-of = Koeffizienten, { $axis }
version-coefficients-count = { $count ->
        [one] 1 Koeffizient
       *[other] { $count } Koeffizienten
    }
version-determined = , davon { $count } bestimmt
version-coefficient = Koeffizient
version-error = Standardfehler
version-relative = Relativ

## Grenzen und Herkunft

version-unknown = Was nicht bekannt ist
version-unknown-range = Manöver außerhalb des obigen Bereichs sowie bei anderen Geschwindigkeiten, Beladungen und Wassertiefen sind extrapoliert.
version-unknown-bands = Die Version hat keine Unsicherheitsbänder: Wie weit ihre Kenngrößen verlässlich sind, ist nicht angegeben.
version-unknown-trials = Sie wurde nicht an Versuche des Schiffes angepasst.
version-unknown-validation = Die <a href="{ $address }">Validierung nach ITTC</a> vergleicht sie mit Versuchen, die sie nicht kennt, soweit vorhanden.
version-lineage = Herkunft und Rezept
version-lineage-label = Herkunft
version-ancestor = Vorläufer
version-descendant = Nachfolger
version-fitted-to = Angepasst an die Versuche { $trials }.
version-recipe = Rezept, das die Version Byte für Byte wiederherstellt
lineage-label = Herkunft von { $version }; die Liste unten hat denselben Inhalt
lineage-trials = { $count ->
        [one] aus 1 Versuch
       *[other] aus { $count } Versuchen
    }
lineage-effects = mit { $effects }
