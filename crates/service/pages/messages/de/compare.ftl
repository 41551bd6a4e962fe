compare-heading = Versionen vergleichen
compare-explained = Zwei bis fünf Versionen: ein Schiff für dessen aktive Version oder Schiff/Nummer angeben. Die Adresse dieser Seite enthält die Auswahl und kann weitergegeben werden.
compare-version-number = Version { $number }
compare-button = Vergleichen
compare-begin = Namen werden beim Tippen angeboten. Auch in der <a href="/">Liste der Flotte</a> oder in der <a href="/?ships=library">Bibliothek</a> lassen sich Schiffe auswählen, auf der Seite eines Schiffes Versionen. Zum Beispiel: <a href="/compare?v=mariner&amp;v=kcs">Mariner und KCS</a>.
compare-speed = Anfangsgeschwindigkeit
compare-turns = Drehkreise mit 35° Ruderlage nach Steuerbord
compare-turns-label = Drehkreise, 35° nach Steuerbord
compare-zigzags = Z-Manöver 20/20
compare-zigzags-label = Z-Manöver 20/20
compare-criteria = Kriterien von IMO MSC.137(76)
compare-standard = Standardmanöver
compare-standard-explained = Simuliert in ruhigem, tiefem Wasser, jede Version ab ihrer Anfangsgeschwindigkeit. Unterschiede beziehen sich auf die erste Version.
compare-coefficients-explained = Koeffizienten gleichen Namens sind nur bei gleicher Modellstruktur vergleichbar.
compare-pass-limit = { $verdict }, Grenzwert { $limit }
compare-too-many = höchstens { $most } Versionen können verglichen werden
compare-not-simulated = { $version } kann nicht simuliert werden: { $reason }
