families-explained = Schiffe, deren Modelle eine gemeinsame Grundlage haben. Der Prior einer Familie beschreibt, wie ihre Mitglieder von der Grundlage abweichen.
families-members = Mitglieder
families-further = Weitere Familien
families-new = Neue Familie
families-short-name = Kurzname
families-short-name-hint = Kleinbuchstaben, Ziffern und Bindestriche. Später nicht änderbar.
families-foundation = Grundlage
families-foundation-hint = Die Version, mit der alle Mitglieder beginnen, als Schiff/Nummer
families-members-hint = Schiffe, durch Leerzeichen getrennt; weitere lassen sich später hinzufügen
families-create = Familie anlegen

## Eine Familie

family-json = Als JSON
family-json-family = Familie
family-json-prior = Prior
family-json-drift = Modelldrift
family-json-refinements = Verfeinerungen
family-condition = Zustand der Mitglieder
family-condition-explained = Schiffe, deren Modell nicht gilt, stehen zuerst, dann die mit der größten Modelldrift: dem Verhältnis der unerklärten Kraft auf neuen zu der auf angepassten Versuchen. Unerklärte Kraft eines Versuchs: ihr quadratisches Mittel geteilt durch das der gesamten Kraft, für die Achse, auf der sie am größten ist.
family-diagnosis = Diagnose
family-drift = Modelldrift
family-over-time = Unerklärte Kraft über die Zeit
family-newest-trial = Neuester Versuch
family-newest = { $at }: { $share } %
family-newest-fitted = { $at }: { $share } % (angepasst)
family-no-members = Noch keine Mitglieder.
family-add-ships = Schiffe hinzufügen
family-add-hint = Durch Leerzeichen getrennt
family-add = Hinzufügen
